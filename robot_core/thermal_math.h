/* Exponential and power for thermal laws, without the C library: the same bits on every machine with IEEE 754 single precision and
   without contraction. Plain C99, because the exported C header contains this text.
   Method: argument reduction to |r| <= ln(2)/2 and a Taylor polynomial; relative error below 3e-7 (exponential), 2e-6 (power for
   |y*log2(x)| <= 20; it grows with that product). */
#ifndef HEATSOAK_THERMAL_MATH_H
#define HEATSOAK_THERMAL_MATH_H 0xe38e043du /* check sum of this text */

#include <stdint.h>

/* 2 to the power of a whole number from -126 to 127. Every product is exact. */
static inline float heatsoak_two_to(int32_t n) {
  float square_factor = n < 0 ? 0.5f : 2.0f;
  float factor = 1.0f;
  int32_t left = n < 0 ? -n : n;
  while (left > 0) {
    factor *= left % 2 == 1 ? square_factor : 1.0f;
    left /= 2;
    square_factor *= left > 0 ? square_factor : 1.0f; /* the next square could be out of range */
  }
  return factor;
}

/* e to the power of x. Below -87 the result is 0, above 88 it is e^88 (1.65e38); NaN gives NaN. */
static inline float heatsoak_exp(float x) {
  const float exponent = x < 88.0f ? x : 88.0f;
  const float rounded_exponent = exponent * 1.44269504f + (exponent < 0.0f ? -0.5f : 0.5f);
  int32_t n;
  float rest_exponent;
  float factor;
  if (!(x >= -87.0f)) {
    return x < -87.0f ? 0.0f : x;
  }
  n = (int32_t)rounded_exponent;
  rest_exponent = (exponent - (float)n * 0.693359375f) + (float)n * 2.12194440e-4f;
  factor = 1.38888889e-3f;
  factor = 8.33333333e-3f + rest_exponent * factor;
  factor = 4.16666667e-2f + rest_exponent * factor;
  factor = 1.66666667e-1f + rest_exponent * factor;
  factor = 0.5f + rest_exponent * factor;
  factor = 1.0f + rest_exponent * factor;
  factor = 1.0f + rest_exponent * factor;
  return factor * heatsoak_two_to(n);
}

/* Natural logarithm of a normal number x > 0. Smaller values count as the smallest normal number, infinity as the largest one. */
static inline float heatsoak_log(float x) {
  /* 2^-1, 2^-2, 2^-4, ... 2^-64 */
  static const float halving_factor[7] = {0.5f, 0.25f, 0.0625f, 0.00390625f, 1.52587891e-5f, 2.32830644e-10f, 5.42101086e-20f};
  float mantissa_ratio = x > 1.17549435e-38f ? x : 1.17549435e-38f;
  int32_t first_exponent = 0;
  int32_t exponent = 0;
  int32_t i;
  float ratio;
  float square_ratio;
  float series_factor;
  mantissa_ratio = mantissa_ratio < 3.40282347e38f ? mantissa_ratio : 3.40282347e38f;
  if (mantissa_ratio < 1.0f) {
    mantissa_ratio *= 8.50705917e37f; /* 2^126 */
    first_exponent = -126;
  }
  for (i = 6; i >= 0; --i) {
    const float scaled_ratio = mantissa_ratio * halving_factor[i];
    exponent *= 2;
    if (scaled_ratio >= 1.0f) {
      mantissa_ratio = scaled_ratio;
      ++exponent;
    }
  }
  exponent += first_exponent;
  if (mantissa_ratio > 1.41421356f) {
    mantissa_ratio *= 0.5f;
    ++exponent;
  }
  ratio = (mantissa_ratio - 1.0f) / (mantissa_ratio + 1.0f);
  square_ratio = ratio * ratio;
  /* 2*artanh(ratio) */
  series_factor = 1.42857143e-1f + square_ratio * 1.11111111e-1f;
  series_factor = 1.0f + square_ratio * (3.33333333e-1f + square_ratio * (0.2f + square_ratio * series_factor));
  return (float)exponent * 0.693359375f + (2.0f * ratio * series_factor - (float)exponent * 2.12194440e-4f);
}

/* x to the power of y for x > 0, else 0. */
static inline float heatsoak_pow(float x, float y) { return x > 0.0f ? heatsoak_exp(y * heatsoak_log(x)) : 0.0f; }

#elif HEATSOAK_THERMAL_MATH_H != 0xe38e043du
#error "generated headers of different heatsoak versions in one program: generate all of them with the same one"
#endif
