#include "select/drive_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace heatsoak::select {
namespace {

/// Motor with K_t = 0.03 N m/A, R = 0.5 Ω, drag 0.006 N m.
motor::MotorValues motor() {
  motor::MotorValues values;
  values.terminal_resistance_ohm = 0.5;
  values.torque_constant_Nm_per_A = 0.03;
  values.no_load_current_A = 0.2;
  values.temperature_coefficient_per_K = 0.004;
  return values;
}

robot::Robot robot() {
  robot::Robot made;
  made.battery.nominal_V = 24.0;
  made.wheels.radius_m = 0.028;
  made.drive.gear_ratio = 2.0;
  made.drive.gear_efficiency = 0.9;
  return made;
}

struct Means {
  double shaft_W = 0.0;
  double input_W = 0.0;
  double copper_W = 0.0;
  double vehicle_m_per_s = 0.0;
};

/// Time means over the moments, with each moment as a separate point.
Means means_of_moments(const std::vector<robot::WheelLoad>& loads) {
  Means means;
  for (const robot::WheelLoad& load : loads) {
    const thermal::OperatingPoint<double> at = robot::operating_point(robot::drive_point(motor(), robot(), load), motor(), robot(), 25.0);
    const auto share = 1.0 / static_cast<double>(loads.size());
    means.shaft_W += share * at.shaft_power_W;
    means.input_W += share * at.input_power_W;
    means.copper_W += share * 0.5 * at.current_rms_A * at.current_rms_A;
    means.vehicle_m_per_s += share * at.vehicle_speed_m_per_s;
  }
  return means;
}

/// The bin either drives or brakes throughout, so that the gear's efficiency is one number. A bin with both uses the efficiency of its
/// mean.
TEST(OperatingPointOfABin, has_the_means_of_its_moments) {
  std::mt19937_64 engine(1200);
  for (const double direction : {1.0, -1.0}) {
    for (int i = 0; i < 50; ++i) {
      std::vector<robot::WheelLoad> loads;
      duty::DemandGatherer gatherer("wheel", 1.0, {});
      for (int k = 0; k < 100; ++k) {
        const double drawn_rad_per_s = std::uniform_real_distribution(-150.0, 150.0)(engine);
        const double speed_rad_per_s = std::copysign(std::max(std::abs(drawn_rad_per_s), duty::kStandstill_rad_per_s), drawn_rad_per_s);
        const double torque_Nm = direction * std::copysign(std::uniform_real_distribution(0.0, 0.1)(engine), speed_rad_per_s);
        loads.push_back({torque_Nm, speed_rad_per_s});
        gatherer.add(0.01, torque_Nm, speed_rad_per_s);
      }
      const duty::WheelDemand demand = gatherer.finish();
      ASSERT_EQ(demand.bins.size(), 1U);
      const thermal::OperatingPoint<double> at = operating_point(motor(), robot(), duty::DutyKind::torque, demand.bins[0], {25.0, 1.0});
      const Means expected = means_of_moments(loads);
      EXPECT_NEAR(at.shaft_power_W, expected.shaft_W, 1e-9);
      EXPECT_NEAR(at.input_power_W, expected.input_W, 1e-9);
      EXPECT_NEAR(0.5 * at.current_rms_A * at.current_rms_A, expected.copper_W, 1e-9);
      EXPECT_NEAR(at.vehicle_speed_m_per_s, expected.vehicle_m_per_s, 1e-12);
      EXPECT_NEAR(at.acceleration_rad_per_s2, 2.0 * demand.bins[0].acceleration_rad_per_s2, 1e-12);
      EXPECT_EQ(at.bus_V, 24.0);
    }
  }
}

TEST(OperatingPointOfABin, asked_for_more_than_the_supply_gives_the_shaft_gets_less) {
  const duty::LoadBin bin = duty::constant_bin(1.0, 0.8, 300.0, 0.0);  // 15 A would need 25.5 V, of which 18 V are back-EMF
  const thermal::OperatingPoint<double> at = operating_point(motor(), robot(), duty::DutyKind::torque, bin, {25.0, 1.0});
  EXPECT_GT(at.shaft_power_W, 0.0);
  EXPECT_LT(at.shaft_power_W, 240.0);
  EXPECT_NEAR(at.modulation_ratio, 1.0, 1e-12);
  // 24 V limits the current to 12 A. The input power is the sum of losses and shaft power at that current.
  EXPECT_NEAR(at.current_rms_A, 12.0, 1e-9);
  EXPECT_NEAR(at.input_power_W, 0.5 * 144.0 + at.shaft_power_W + 0.006 * 600.0, 1e-9);
}

TEST(OperatingPointOfABin, of_a_given_current_has_the_power_that_the_current_makes) {
  const duty::LoadBin bin = duty::constant_bin(1.0, 0.0, 50.0, 4.0);
  const thermal::OperatingPoint<double> at = operating_point(motor(), robot(), duty::DutyKind::current, bin, {25.0, 1.0});
  EXPECT_NEAR(at.shaft_power_W, (0.03 * 4.0 - 0.006) * 100.0, 1e-12);
  EXPECT_NEAR(at.input_power_W, 4.0 * (4.0 * 0.5 + 0.03 * 100.0), 1e-12);
}

}  // namespace
}  // namespace heatsoak::select
