// A 32-bit integer as two floats that hold it exactly: its low and its high 16 bits, each in [0, 65535].
// For GLSL without bit operators (< 1.30); two's complement by floored division.
SD_HIGHP float sd_high(SD_HIGHP int value) {
  SD_HIGHP int quotient = value / 65536;
  if (value - quotient * 65536 < 0) quotient -= 1;
  if (quotient < 0) quotient += 65536;
  return float(quotient);
}
SD_HIGHP float sd_low(SD_HIGHP int value) {
  SD_HIGHP int remainder = value - (value / 65536) * 65536;
  if (remainder < 0) remainder += 65536;
  return float(remainder);
}
