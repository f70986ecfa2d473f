#version 100
#ifdef GL_FRAGMENT_PRECISION_HIGH
precision highp float;
#else
precision mediump float;
#endif
varying vec2 v_texCoord;
uniform sampler2D u_image;
uniform lowp float u_radius;

vec4 tap(in vec2 offset) {
  mediump vec4 c = texture2D(u_image, v_texCoord + offset * u_radius);
  return c;
}

void main(void) {
  vec4 sum = vec4(0.0);
  for (int i = -2; i <= 2; i++) {
    sum += tap(vec2(float(i), 0.0)) * (3.0 - abs(float(i)));
  }
  gl_FragColor = sum / 9.0;
}
