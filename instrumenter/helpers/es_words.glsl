// Conversions between integers keep the bits only at full precision: a parameter that is highp has a mediump value
// extended first, as its own type wants it.
highp uint sd_uint(highp int value) { return uint(value); }
highp int sd_int(highp uint value) { return int(value); }
