// Replacements for the few functions of <cmath> that the drive core needs: a freestanding build has no <cmath>.
#pragma once

#include <cstdint>
#include <limits>

namespace robot_core {

/// Absolute value in one instruction.
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

/// Returns false for NaN and both infinities.
template <typename Real>
constexpr bool is_finite(Real x) {
  return absolute(x) <= std::numeric_limits<Real>::max();
}

namespace detail {

// One correctly rounded instruction if the target has it. The core needs -fno-math-errno: otherwise the builtin also calls the C
// library.
inline double sqrt_instruction(double x) { return __builtin_sqrt(x); }
inline float sqrt_instruction(float x) { return __builtin_sqrtf(x); }

}  // namespace detail

/// Square root; 0 for a negative number, which only a rounding error of zero produces here.
template <typename Real>
inline Real square_root(Real x) {
  return x > Real(0) ? detail::sqrt_instruction(x) : Real(0);
}

/// Sign of x, smoothed over `width` around zero: x/√(x² + width²). Returns 0 if `width` is not positive.
inline float smooth_sign(float x, float width) { return width > 0.0F ? x / square_root(x * x + width * width) : 0.0F; }

/// Running check sum, the halves of a 64-bit number.
struct CheckSum {
  std::uint32_t low;
  std::uint32_t high;

  /// Multiplies by an odd number, adds a word and exchanges the halves, so the weight of a bit depends on the position of its word.
  constexpr CheckSum with(std::uint64_t word) const {
    constexpr std::uint32_t kMultiplier = 0x85EBCA6BU;
    // In this form each word takes two instructions of a Cortex-M7.
    const std::uint64_t sum = word + std::uint64_t{low} * kMultiplier;
    return {static_cast<std::uint32_t>(sum >> 32U) + kMultiplier * high, static_cast<std::uint32_t>(sum)};
  }
  constexpr std::uint64_t value() const { return std::uint64_t{high} << 32U | low; }
};

/// Check sum of an object with 8-byte alignment from the 8-byte word `first` to `last` - 1. Every single flipped bit changes it, and so do
/// more than 99.99 % of the pairs of flipped bits. Even and odd words have separate sums, which a host calculates at the same time.
template <unsigned first, unsigned last>
std::uint64_t check_sum_of_words(const void* object, std::uint64_t seed) {
  const auto* const at = static_cast<const unsigned char*>(object);
  CheckSum sum[2] = {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)}, {0U, 0U}};
  // Fully unrolled, because the drive core spends a good part of its time here.
#pragma GCC unroll 128
  for (unsigned i = first; i < last; ++i) {
    std::uint64_t word = 0;
    __builtin_memcpy(&word, __builtin_assume_aligned(at + i * sizeof(word), sizeof(word)), sizeof(word));
    sum[i % 2] = sum[i % 2].with(word);
  }
  // A multiple of a highest bit is that bit, so the rotation keeps it apart from the same bit of the neighbouring word. The last round
  // separates the final words from the stored sum.
  sum[1].high = sum[1].high << 16U | sum[1].high >> 16U;
  return sum[0].with(sum[1].value()).with(0U).value();
}

struct SineCosine {
  float sine_ratio = 0.0F;
  float cosine_ratio = 1.0F;
};

/// Sine and cosine, with an error below 4e-7. Angles are clamped to ±1000 rad.
SineCosine sine_cosine(float angle_rad);

}  // namespace robot_core
