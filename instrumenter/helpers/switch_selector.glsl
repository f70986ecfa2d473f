// switch (sd_select(sd_keep((e)), (..., true))): e is evaluated and kept, then what stands at the dots runs, then e is
// the result. Works for both types that a selector can have; arguments are evaluated from left to right.
SD_HIGHP int sd_selector;
SD_HIGHP int sd_keep(SD_HIGHP int value) {
  sd_selector = value;
  return value;
}
SD_HIGHP uint sd_keep(SD_HIGHP uint value) {
  sd_selector = int(value);
  return value;
}
SD_HIGHP int sd_select(SD_HIGHP int value, bool done) { return value; }
SD_HIGHP uint sd_select(SD_HIGHP uint value, bool done) { return value; }
