// Tests exponential and power of the thermal laws against the C library in double precision.
#include "robot_core/thermal_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace {

double relative_error(float value, double exact) { return std::abs(static_cast<double>(value) / exact - 1.0); }

float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// The documented error is below 3e-7.
TEST(ThermalMath, ExponentialOverItsRange) {
  double most = 0.0;
  // Tests every 61st number on both sides of 0, starting with the smallest normal one.
  for (std::uint32_t bits = 0x00800000U; bits <= std::bit_cast<std::uint32_t>(88.0F); bits += 61) {
    const float x = float_of(bits);
    most = std::fmax(most, relative_error(heatsoak_exp(x), std::exp(static_cast<double>(x))));
    if (x <= 87.0F) {
      most = std::fmax(most, relative_error(heatsoak_exp(-x), std::exp(-static_cast<double>(x))));
    }
  }
  EXPECT_LT(most, 3e-7);
}

TEST(ThermalMath, ExponentialAtTheEndsOfItsRange) {
  EXPECT_EQ(heatsoak_exp(0.0F), 1.0F);
  EXPECT_EQ(heatsoak_exp(-0.0F), 1.0F);
  EXPECT_EQ(heatsoak_exp(-87.1F), 0.0F);
  EXPECT_EQ(heatsoak_exp(-std::numeric_limits<float>::infinity()), 0.0F);
  EXPECT_GT(heatsoak_exp(-87.0F), std::numeric_limits<float>::min());
  EXPECT_EQ(heatsoak_exp(89.0F), heatsoak_exp(88.0F));
  EXPECT_EQ(heatsoak_exp(std::numeric_limits<float>::infinity()), heatsoak_exp(88.0F));
  EXPECT_TRUE(std::isfinite(heatsoak_exp(88.0F)));
  EXPECT_TRUE(std::isnan(heatsoak_exp(std::numeric_limits<float>::quiet_NaN())));
}

// The exponential must be monotonic: otherwise a search for the hottest candidate value could miss it.
TEST(ThermalMath, ExponentialRisesWithinItsRounding) {
  float last = 0.0F;
  for (float x = -87.0F; x <= 88.0F; x += 1e-3F) {
    EXPECT_GT(heatsoak_exp(x), last) << x;
    last = heatsoak_exp(x);
  }
}

TEST(ThermalMath, LogarithmOverAllNormalNumbers) {
  double most = 0.0;
  for (std::uint32_t bits = 0x00800000U; bits < 0x7F800000U; bits += 211) {
    const float x = float_of(bits);
    if (x != 1.0F) {
      most = std::fmax(most, relative_error(heatsoak_log(x), std::log(static_cast<double>(x))));
    }
  }
  // Close to 1 every number is tested, because the result is nearly 0.
  for (std::uint32_t bits = std::bit_cast<std::uint32_t>(0.99F); bits < std::bit_cast<std::uint32_t>(1.01F); ++bits) {
    if (bits != std::bit_cast<std::uint32_t>(1.0F)) {
      most = std::fmax(most, relative_error(heatsoak_log(float_of(bits)), std::log(static_cast<double>(float_of(bits)))));
    }
  }
  EXPECT_LT(most, 3e-7);
  EXPECT_EQ(heatsoak_log(1.0F), 0.0F);
  EXPECT_EQ(heatsoak_log(0.0F), heatsoak_log(std::numeric_limits<float>::min()));
}

TEST(ThermalMath, PowersOfTwoAreExact) {
  for (int n = -126; n <= 127; ++n) {
    EXPECT_EQ(heatsoak_two_to(n), std::ldexp(1.0F, n));
  }
}

// The reduction by products with powers of two must have the bits of one that takes exponent and mantissa from the bits of the number.
TEST(ThermalMath, LogarithmHasTheBitsOfAnExactReduction) {
  const auto reference = [](float x) {
    const auto bits = std::bit_cast<std::uint32_t>(std::max(x, std::numeric_limits<float>::min()));
    std::int32_t exponent = static_cast<std::int32_t>(bits >> 23U) - 127;
    float mantissa = float_of((bits & 0x007fffffU) | 0x3f800000U);
    if (mantissa > 1.41421356F) {
      mantissa *= 0.5F;
      ++exponent;
    }
    const float ratio = (mantissa - 1.0F) / (mantissa + 1.0F);
    const float square = ratio * ratio;
    const float last = 1.42857143e-1F + square * 1.11111111e-1F;
    const float series = 1.0F + square * (3.33333333e-1F + square * (0.2F + square * last));
    const auto whole = static_cast<float>(exponent);
    return whole * 0.693359375F + (2.0F * ratio * series - whole * 2.12194440e-4F);
  };
  for (std::uint64_t bits = 0; bits <= 0x7F800000U; bits += 127) {
    const float x = float_of(static_cast<std::uint32_t>(bits));
    ASSERT_EQ(std::bit_cast<std::uint32_t>(heatsoak_log(x)), std::bit_cast<std::uint32_t>(reference(x))) << x;
  }
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(heatsoak_log(infinity), reference(infinity));
}

// The documented error is below 2e-6 up to |y·log2 x| = 20. Above, the error of the logarithm grows with the product.
TEST(ThermalMath, PowerOverItsRange) {
  double most = 0.0;
  double most_beyond = 0.0;
  for (std::uint32_t bits = 0x2F800000U; bits < 0x4F800000U; bits += 99'991) {
    const float x = float_of(bits);
    for (int i = -300; i <= 300; ++i) {
      const float y = 0.0237F * static_cast<float>(i);
      const double product = std::abs(y * std::log2(static_cast<double>(x)));
      const double error = relative_error(heatsoak_pow(x, y), std::pow(static_cast<double>(x), static_cast<double>(y)));
      (product <= 20.0 ? most : most_beyond) = std::fmax(product <= 20.0 ? most : most_beyond, product <= 120.0 ? error : 0.0);
    }
  }
  EXPECT_LT(most, 2e-6);
  EXPECT_LT(most_beyond, 1.2e-5);
}

TEST(ThermalMath, PowerOfWhatIsNotPositiveIsZero) {
  EXPECT_EQ(heatsoak_pow(0.0F, 0.5F), 0.0F);
  EXPECT_EQ(heatsoak_pow(-2.0F, 2.0F), 0.0F);
  EXPECT_EQ(heatsoak_pow(std::numeric_limits<float>::quiet_NaN(), 2.0F), 0.0F);
  EXPECT_EQ(heatsoak_pow(7.0F, 0.0F), 1.0F);
}

}  // namespace
