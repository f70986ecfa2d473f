// The first pixel of the 2 x 2 quad along one axis, from one of its pixels: quads may begin at odd pixels, too. `change`
// is the derivative of the pixel's parity.
int sd_quad(int place, float change) {
  float parity = mod(float(place), 2.0);
  return place - int(mod(parity + (change < 0.0 ? 1.0 : 0.0), 2.0));
}

// A quad is recorded as a whole or not at all: derivatives need all of its threads in the same code.
bool sd_near(ivec2 place) {
  vec2 parity = mod(vec2(place), 2.0);
  ivec2 first = ivec2(sd_quad(place.x, dFdx(parity.x)), sd_quad(place.y, dFdy(parity.y)));
  return first.x < sd_pixel.x + sd_pixel.z && first.x + 2 > sd_pixel.x && first.y < sd_pixel.y + sd_pixel.w &&
         first.y + 2 > sd_pixel.y;
}

// True if this thread runs the code that records; whether it is recorded says sd_on.
bool sd_begin() {
  sd_on = false;
  sd_invocation = 0;
  ivec2 place = ivec2(floor(gl_FragCoord.xy));
  bool near = sd_near(place);
  ivec2 inside = place - sd_pixel.xy;
  if (inside.x >= 0 && inside.y >= 0 && inside.x < sd_pixel.z && inside.y < sd_pixel.w) sd_start(place.x, place.y);
  return near;
}
