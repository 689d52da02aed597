#include "base/unit_names.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/quantity.h"

namespace heatsoak::base {
namespace {

std::string unit(std::string_view name) {
  const std::optional<UnitOfName> found = unit_of_name(name);
  return found ? found->unit : "none";
}

TEST(UnitOfName, IsReadFromItsLastWords) {
  EXPECT_EQ(unit("winding_peak_C"), "degC");
  EXPECT_EQ(unit("guard_missing_A_s"), "A s");
  EXPECT_EQ(unit("temperature_coefficient_per_K"), "1/K");
  EXPECT_EQ(unit("slope_A_per_K_s"), "A/(K s)");
  EXPECT_EQ(unit("heat_J_per_kg_per_K"), "J/(kg K)");
  EXPECT_EQ(unit("damping_V_s_per_rad"), "V s/rad");
  EXPECT_EQ(unit("a_V"), "V");
  EXPECT_EQ(unit("phase_A_C"), "degC") << "a temperature is no factor of a product";
  EXPECT_EQ(unit("winding_per_stator_K"), "K");
  EXPECT_EQ(unit("delivered_share"), "") << "a pure number";
  EXPECT_EQ(unit("stator_C_share"), "") << "a share of something with a unit";
  for (const char* none : {"current_per_iq", "V", "", "_", "m_per", "_s", "samples", "p95", "C_peak"}) {
    EXPECT_EQ(unit(none), "none") << none;
  }
  EXPECT_EQ(unit("nats"), "");
  EXPECT_EQ(unit_of_name("wheel_speed_rad_per_s")->quantity, "wheel_speed");
  EXPECT_EQ(unit_of_name("delivered_share")->quantity, "delivered");
}

// UDUNITS-2 knows dimension and size of the units independently, without byte, and deg alone.
TEST(UnitOfName, HasTheSizeOfItsText) {
  for (const UnitWord& each : kUnitWords) {
    if (each.unit.empty() || each.word == "byte" || each.word == "deg") {
      continue;
    }
    for (const std::string& name :
         {fmt::format("x_{}", each.word), fmt::format("x_per_{}", each.word), fmt::format("x_A_{}_per_s", each.word)}) {
      const UnitOfName found = *unit_of_name(name);
      const SiUnit& si = found.si;
      const std::string text = fmt::format("kg{} m{} s{} A{} K{} rad{}", si.kg, si.m, si.s, si.A, si.K, si.rad);
      const double zero = convert(0.0, found.unit, text);
      const double one = convert(1.0, found.unit, text);
      EXPECT_NEAR((one - zero) / si.factor, 1.0, 1e-12) << name << " = " << found.unit << " = " << text;
      EXPECT_NEAR(zero, si.offset_K, 1e-9) << name;
    }
  }
}

TEST(NumberWithUnit, IsADigitBeforeAUnit) {
  for (const char* const behind : {"K", "°C,", "%", "m/s² and", "rad/s", "kW", "mΩ", "µs", "nats.", "min)", "N·m"}) {
    EXPECT_TRUE(is_number_with_unit("at 20", behind)) << behind;
  }
  for (const char* const behind : {"motors", "and", "mean", "(K)", "", "up", "share"}) {
    EXPECT_FALSE(is_number_with_unit("at 20", behind)) << behind;
  }
  EXPECT_FALSE(is_number_with_unit("in", "K"));
  EXPECT_FALSE(is_number_with_unit("", "K"));
}

}  // namespace
}  // namespace heatsoak::base
