// The few functions of <cmath> that the drive core needs: a freestanding build has no <cmath>.
#pragma once

#include <cstdint>
#include <limits>

namespace robot_core {

/// Without the sign: one instruction.
constexpr float absolute(float x) { return __builtin_fabsf(x); }
constexpr double absolute(double x) { return __builtin_fabs(x); }

template <typename Real>
constexpr Real smaller(Real a, Real b) {
  return b < a ? b : a;
}

template <typename Real>
constexpr Real larger(Real a, Real b) {
  return a < b ? b : a;
}

template <typename Real>
constexpr Real clamped(Real x, Real low, Real high) {
  return x < low ? low : (high < x ? high : x);
}

/// False for NaN and both infinities.
template <typename Real>
constexpr bool is_finite(Real x) {
  return absolute(x) <= std::numeric_limits<Real>::max();
}

namespace detail {

// One correctly rounded instruction where the target has it: the core is compiled with -fno-math-errno, without which
// the builtin would also call the C library.
inline double sqrt_instruction(double x) { return __builtin_sqrt(x); }
inline float sqrt_instruction(float x) { return __builtin_sqrtf(x); }

}  // namespace detail

/// Square root; of a negative number (a rounding error of zero, where this is used) it is 0.
template <typename Real>
inline Real square_root(Real x) {
  return x > Real(0) ? detail::sqrt_instruction(x) : Real(0);
}

/// x with the sign's jump at zero spread over `width`: x/√(x² + width²).
inline float smooth_sign(float x, float width) { return width > 0.0F ? x / square_root(x * x + width * width) : 0.0F; }

/// Word number `i` of an object, for check sums.
inline std::uint32_t word_of(const void* object, unsigned i) {
  std::uint32_t word = 0;
  __builtin_memcpy(&word, static_cast<const unsigned char*>(object) + i * sizeof(word), sizeof(word));
  return word;
}

/// Sum of the 8-byte words `first` to `last` - 1 of an object at an address that 8 divides: every flip of a single bit changes it.
template <unsigned first, unsigned last>
std::uint64_t sum_of_words(const void* object) {
  const auto* const at = static_cast<const unsigned char*>(object);
  std::uint64_t sum = 0;
  // Wholly unrolled: the drive core spends a good part of its time here.
#pragma GCC unroll 128
  for (unsigned i = first; i < last; ++i) {
    std::uint64_t word = 0;
    __builtin_memcpy(&word, __builtin_assume_aligned(at + i * sizeof(word), sizeof(word)), sizeof(word));
    sum += word;
  }
  return sum;
}

struct SineCosine {
  float sine = 0.0F;
  float cosine = 1.0F;
};

/// Error below 3e-7 for |angle| up to 1000 rad, which larger angles are taken for. Method: reduction to ±π/4 by a two-part π/2 (Cody and
/// Waite 1980), Taylor polynomials.
inline SineCosine sine_cosine(float angle_rad) {
  const float x = clamped(angle_rad, -1000.0F, 1000.0F);
  const int quarter = static_cast<int>(x * 0.636619772F + (x < 0.0F ? -0.5F : 0.5F));
  const auto turns = static_cast<float>(quarter);
  const float r = ((x - turns * 1.5703125F) - turns * 4.837512969970703e-4F) - turns * 7.549790126e-8F;
  const float r2 = r * r;
  const float s = r * (1.0F + r2 * (-1.66666667e-1F + r2 * (8.33333333e-3F - r2 * 1.98412698e-4F)));
  const float c = 1.0F + r2 * (-0.5F + r2 * (4.16666667e-2F + r2 * (-1.38888889e-3F + r2 * 2.48015873e-5F)));
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace robot_core
