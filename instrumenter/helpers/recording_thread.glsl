// True if this thread is recorded: the one that sd_pixel names.
bool sd_begin() {
  sd_on = false;
  sd_invocation = 0;
  ivec3 thread = sd_identity();
  if (thread == sd_pixel.xyz) sd_start(thread.x, thread.y);
  return sd_on;
}
