/* Exponential and power for thermal laws, without the C library: the same bits on every machine with IEEE 754 single precision and
   without contraction. Plain C99, because the exported C header contains this text.
   Method: argument reduction to |r| <= ln(2)/2 and a Taylor polynomial; relative error below 3e-7 (exponential), 2e-6 (power for
   |y*log2(x)| <= 20; it grows with that product). */
#ifndef HEATSOAK_THERMAL_MATH_H
#define HEATSOAK_THERMAL_MATH_H

#include <stdint.h>

/* 2 to the power of a whole number from -126 to 127. */
static inline float heatsoak_two_to(int32_t n) {
  union {
    uint32_t bits;
    float value;
  } made;
  made.bits = (uint32_t)(n + 127) << 23;
  return made.value;
}

/* e to the power of x. Below -87 the result is 0, above 88 it is e^88 (1.65e38); NaN gives NaN. */
static inline float heatsoak_exp(float x) {
  int32_t n;
  float rest_exponent, factor;
  if (!(x >= -87.0f)) {
    return x < -87.0f ? 0.0f : x;
  }
  if (x > 88.0f) {
    x = 88.0f;
  }
  n = (int32_t)(x * 1.44269504f + (x < 0.0f ? -0.5f : 0.5f));
  rest_exponent = (x - (float)n * 0.693359375f) + (float)n * 2.12194440e-4f;
  factor = 1.38888889e-3f;
  factor = 8.33333333e-3f + rest_exponent * factor;
  factor = 4.16666667e-2f + rest_exponent * factor;
  factor = 1.66666667e-1f + rest_exponent * factor;
  factor = 0.5f + rest_exponent * factor;
  factor = 1.0f + rest_exponent * factor;
  factor = 1.0f + rest_exponent * factor;
  return factor * heatsoak_two_to(n);
}

/* Natural logarithm of a normal number x > 0. Smaller values count as the smallest normal number. */
static inline float heatsoak_log(float x) {
  union {
    float value;
    uint32_t bits;
  } of;
  int32_t exponent;
  float ratio, square_ratio, series_factor;
  of.value = x > 1.17549435e-38f ? x : 1.17549435e-38f;
  exponent = (int32_t)(of.bits >> 23) - 127;
  of.bits = (of.bits & 0x007fffffu) | 0x3f800000u;
  if (of.value > 1.41421356f) {
    of.value *= 0.5f;
    ++exponent;
  }
  ratio = (of.value - 1.0f) / (of.value + 1.0f);
  square_ratio = ratio * ratio;
  /* 2*artanh(ratio) */
  series_factor = 1.42857143e-1f + square_ratio * 1.11111111e-1f;
  series_factor = 1.0f + square_ratio * (3.33333333e-1f + square_ratio * (0.2f + square_ratio * series_factor));
  return (float)exponent * 0.693359375f + (2.0f * ratio * series_factor - (float)exponent * 2.12194440e-4f);
}

/* x to the power of y for x > 0, else 0. */
static inline float heatsoak_pow(float x, float y) { return x > 0.0f ? heatsoak_exp(y * heatsoak_log(x)) : 0.0f; }

#endif
