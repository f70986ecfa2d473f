// A 32-bit integer as two floats that hold it exactly: its low and its high 16 bits, each in [0, 65535].
// For GLSL without bit operators (< 1.30); two's complement by floored division.
float sd_high(int value) {
  int quotient = value / 65536;
  if (value - quotient * 65536 < 0) quotient -= 1;
  if (quotient < 0) quotient += 65536;
  return float(quotient);
}
float sd_low(int value) {
  int remainder = value - (value / 65536) * 65536;
  if (remainder < 0) remainder += 65536;
  return float(remainder);
}
