// The threads that count: those of the pixels in the block's head, in gl_FragCoord's own convention.
void sd_begin() {
  ivec2 inside = ivec2(floor(gl_FragCoord.xy)) - ivec2(sd_words[0], sd_words[1]);
  sd_on = inside.x >= 0 && inside.y >= 0 && inside.x < sd_words[2] && inside.y < sd_words[3];
  if (sd_on) atomicAdd(sd_words[4], 1);
}
