// Names of channels: names of the table, numbered names, or free names with a unit at the end.
#include "recording/quantities.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace heatsoak::recording {
namespace {

std::string unit_of(const char* key) {
  const auto quantity = quantity_named(key);
  return quantity ? quantity->unit : "none";
}

TEST(Quantities, NamesTellTheirUnits) {
  EXPECT_EQ(unit_of("winding_C"), "degC");
  EXPECT_EQ(unit_of("wheel_speed_rad_per_s_3"), "rad/s");
  EXPECT_EQ(unit_of("thrust_N"), "N");
  EXPECT_EQ(unit_of("T_esc_C"), "degC") << "not coulomb";
  EXPECT_EQ(unit_of("flow_m3_per_s"), "m3/s");
  EXPECT_EQ(unit_of("rotor_inertia_kg_m2"), "kg m2");
  EXPECT_EQ(unit_of("resistance_K_per_W"), "K/W");
  EXPECT_EQ(unit_of("valve_ratio"), "");
  EXPECT_EQ(unit_of("duty_pct"), "%");
  EXPECT_EQ(unit_of("pressure_kPa"), "kPa") << "any unit of UDUNITS-2";
  EXPECT_EQ(unit_of("phase_a_A"), "A") << "not ampere-years";
  EXPECT_EQ(unit_of("phase_A_C"), "degC") << "a temperature is no factor of a product";
  for (const char* phase : {"A", "B", "C", "U", "V", "W"}) {
    EXPECT_EQ(unit_of(("phase_" + std::string(phase) + "_V").c_str()), "V") << "a letter of a phase is no factor of a product";
    EXPECT_EQ(unit_of(("phase_" + std::string(phase) + "_A").c_str()), "A");
  }
  EXPECT_EQ(unit_of("charge_A_s"), "A s");
  EXPECT_EQ(unit_of("conductance_W_per_m2_K"), "W/(m2 K)");
  EXPECT_EQ(unit_of("coefficient_per_K"), "1/K");
  EXPECT_EQ(unit_of("acceleration_m_per_s2"), "m/s2");
  for (const char* key : {"comment", "winding", "C", "_C", "a__C", "time", "motor_speed_fast", "wheel_1", "x_2", ""}) {
    EXPECT_EQ(unit_of(key), "none") << key;
  }
}

TEST(Quantities, TableIsSoundAndItsNamesEndInTheirUnits) {
  std::set<std::string_view> keys;
  for (const QuantityType& type : quantity_types()) {
    EXPECT_TRUE(keys.insert(type.key).second) << type.key;
    EXPECT_FALSE(type.meaning.empty()) << type.key;
    const std::string free_name = "another_" + std::string(type.key);
    ASSERT_TRUE(quantity_named(free_name)) << free_name;
    EXPECT_EQ(quantity_named(free_name)->unit, type.unit) << "the name itself would state another unit";
    EXPECT_EQ(quantity_named(std::string(type.key) + (type.is_numbered ? "_2" : ""))->kind, type.kind) << type.key;
  }
}

TEST(Quantities, AliasGivesTheQuantityOfTheTable) {
  EXPECT_EQ(quantity_named("duty_ratio")->key, "modulation_ratio");
  EXPECT_EQ(quantity_named("wheel_pwm_ratio_3")->key, "wheel_modulation_ratio_3");
  EXPECT_EQ(quantity_named("wheel_pwm_ratio_3")->meaning, quantity_named("wheel_modulation_ratio_3")->meaning);
  EXPECT_EQ(canonical_key("winding_C"), "winding_C");
  EXPECT_EQ(earlier_key("wheel_modulation_ratio_3"), "wheel_pwm_ratio_3");
  EXPECT_EQ(earlier_key("winding_C"), "winding_C");
  for (const QuantityType& type : quantity_types()) {
    for (const QuantityType& other : quantity_types()) {
      EXPECT_NE(type.key, other.alias) << "the alias of one quantity is the name of another";
    }
  }
}

TEST(Quantities, NearestNameIsSuggested) { EXPECT_EQ(nearest_quantity("windng_C"), "; did you mean 'winding_C'?"); }

}  // namespace
}  // namespace heatsoak::recording
