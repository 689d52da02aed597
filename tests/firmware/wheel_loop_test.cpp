// The gains in the loop that they were designed for: one wheel with its motor and the delays of a real controller.
#include "firmware/wheel_loop.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "base/diagnostic.h"
#include "firmware/friction_voltage.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

struct WheelCase {
  const char* robot;
  const char* motor;
};
constexpr WheelCase kWheelCases[] = {{"roboteam_twente_v2024", "maxon_ecx_flat_32l_48v"},
                                     {"roboteam_twente_v2025", "maxon_ecx_flat_42m_24v"},
                                     {"tigers_v2020", "nanotec_df45l024048_a2"}};

WheelLoopPlant plant_of(const WheelCase& each) {
  const robot::Robot robot = shipped_robot(each.robot);
  const motor::Motor motor = shipped_motor(each.motor);
  return wheel_loop_plant(make_body_with_known_friction(robot, motor.nominal), robot::drive_constants(robot, motor.nominal));
}

/// One wheel with the given inertia under PI control, exact for a voltage that is held over a period. The controller gets the mean speed of
/// the last period, and its output acts one period later. States: speed, measured speed, acting voltage, integral.
struct Loop {
  Eigen::Matrix4d matrix;

  /// `efficiency` is the gear's. `body_V_s_per_rad` is an additional gain on the wheel's error, which the body loop adds.
  Loop(const WheelLoopPlant& plant, const WheelLoopGains& gains, double period_s, double inertia_kg_m2, double efficiency,
       double body_V_s_per_rad = 0.0) {
    const double time_constant_s = inertia_kg_m2 * plant.volt_per_Nm / (plant.back_emf_V_s_per_rad * efficiency);
    const double kept = std::exp(-period_s / time_constant_s);
    const double mean = (1.0 - kept) * time_constant_s / period_s;
    const double per_V = 1.0 / plant.back_emf_V_s_per_rad;
    const double gain = gains.wheel_gain_V_s_per_rad + body_V_s_per_rad;
    const double integral = gains.wheel_integral_V_per_rad * period_s;
    // Held voltage u; the next voltage follows from the mean speed of the previous period: e = −measured.
    matrix << kept, 0.0, (1.0 - kept) * per_V, 0.0,  //
        mean, 0.0, (1.0 - mean) * per_V, 0.0,        //
        0.0, -gain - integral, 0.0, 1.0,             //
        0.0, -integral, 0.0, 1.0;
  }

  /// Loop without the integral state, whose pole is at 1 if the integral gain is zero.
  [[nodiscard]] Eigen::Matrix3d proportional() const { return matrix.topLeftCorner<3, 3>(); }
  [[nodiscard]] double largest_pole() const { return Eigen::EigenSolver<Eigen::Matrix4d>(matrix).eigenvalues().cwiseAbs().maxCoeff(); }
};

TEST(WheelLoop, OscillatesAtTheUltimateGainOfItsDerivation) {
  // An integrator with these delays: a huge time constant and no integral gain.
  WheelLoopPlant plant;
  plant.back_emf_V_s_per_rad = 0.03;
  plant.volt_per_Nm = 30.0;
  constexpr double kInertia_kg_m2 = 1.0;
  constexpr double kOwnPeriod_s = 0.001;
  const double ultimate = 2.0 * std::tan(std::numbers::pi / 8.0);
  const auto pole_at = [&](double ratio) {
    WheelLoopGains gains;
    gains.wheel_gain_V_s_per_rad = ratio * ultimate * kInertia_kg_m2 * plant.volt_per_Nm / kOwnPeriod_s;
    return Eigen::Vector3cd(
        Eigen::EigenSolver<Eigen::Matrix3d>(Loop(plant, gains, kOwnPeriod_s, kInertia_kg_m2, 1.0).proportional()).eigenvalues());
  };
  EXPECT_NEAR(pole_at(1.0).cwiseAbs().maxCoeff(), 1.0, 1e-5);
  EXPECT_LT(pole_at(0.99).cwiseAbs().maxCoeff(), 1.0);
  EXPECT_GT(pole_at(1.01).cwiseAbs().maxCoeff(), 1.0);
  double angle_rad = 0.0;
  for (const std::complex<double>& pole : pole_at(1.0)) {
    angle_rad = std::abs(std::abs(pole) - 1.0) < 1e-5 ? std::max(angle_rad, std::abs(std::arg(pole))) : angle_rad;
  }
  EXPECT_NEAR(angle_rad, std::numbers::pi / 4.0, 1e-5);
}

// Without delay the closed loop must have the specified double pole.
TEST(WheelLoop, PlacesThePolesOfTheLoadedWheel) {
  for (const WheelCase& each : kWheelCases) {
    const WheelLoopPlant plant = plant_of(each);
    const WheelLoopGains gains = wheel_loop_gains(plant, 0.001);
    const double time_constant_s = plant.loaded_inertia_kg_m2 * plant.volt_per_Nm / (plant.back_emf_V_s_per_rad * plant.gear_efficiency);
    const double linear = (1.0 + gains.wheel_gain_V_s_per_rad / plant.back_emf_V_s_per_rad) / time_constant_s;
    const double constant = gains.wheel_integral_V_per_rad / (time_constant_s * plant.back_emf_V_s_per_rad);
    EXPECT_NEAR(linear * linear, 4.0 * constant, 1e-9 * linear * linear) << each.robot;
    EXPECT_NEAR(linear, gains.wheel_rate_per_s, 1e-9 * linear) << each.robot;
    EXPECT_LE(0.5 * linear * 2.0 * 0.001, 0.2 * (1.0 + 1e-9)) << each.robot;
  }
}

TEST(WheelLoop, IsStableWithHalfAndDoubleInertiaOnTheGroundAndInTheAir) {
  for (const WheelCase& each : kWheelCases) {
    const WheelLoopPlant plant = plant_of(each);
    for (const double period_s : {0.00025, 0.001, 0.002, 0.003}) {
      const WheelLoopGains gains = wheel_loop_gains(plant, period_s);
      const std::string where = std::string(each.robot) + ", " + std::to_string(period_s);
      for (const double part : {0.5, 1.0, 2.0}) {
        EXPECT_LT(Loop(plant, gains, period_s, part * plant.loaded_inertia_kg_m2, plant.gear_efficiency).largest_pole(), 1.0) << where;
        EXPECT_LT(Loop(plant, gains, period_s, part * plant.wheel_inertia_kg_m2, 1.0).largest_pole(), 1.0) << where << " in the air";
      }
      // The body loop controls the same wheels. If all of them are in the air, it adds its force to each.
      const double body_V_s_per_rad =
          gains.body_gain_per_s * (plant.hardest_body_inertia_kg_m2 + plant.wheel_inertia_kg_m2) * plant.volt_per_Nm;
      for (const double part : {0.75, 1.0, 2.0}) {
        EXPECT_LT(Loop(plant, gains, period_s, part * plant.wheel_inertia_kg_m2, 1.0, body_V_s_per_rad).largest_pole(), 1.0) << where;
      }
      EXPECT_GT(gains.body_gain_per_s, 0.0) << where;
      EXPECT_LT(gains.body_gain_per_s, gains.wheel_rate_per_s) << where;
      EXPECT_LT(gains.yaw_gain_per_s, gains.wheel_rate_per_s) << where;
    }
  }
}

/// Returns the overshoot of a reference step on the loaded wheel without feed-forward.
double overshoot(const Loop& loop, const WheelLoopGains& gains, double period_s, double& settled_s) {
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  double most = 0.0;
  settled_s = 0.0;
  for (int k = 0; k < 20'000; ++k) {
    const double integral = gains.wheel_integral_V_per_rad * period_s;
    state = loop.matrix * state + Eigen::Vector4d(0.0, 0.0, gains.wheel_gain_V_s_per_rad + integral, integral);
    most = std::max(most, state[0]);
    settled_s = std::abs(state[0] - 1.0) > 0.02 ? (k + 1) * period_s : settled_s;
  }
  EXPECT_NEAR(state[0], 1.0, 1e-6);
  return most - 1.0;
}

TEST(WheelLoop, SettlesWithoutMuchOvershoot) {
  for (const WheelCase& each : kWheelCases) {
    const WheelLoopPlant plant = plant_of(each);
    const WheelLoopGains gains = wheel_loop_gains(plant, 0.001);
    for (const double part : {0.5, 1.0, 2.0}) {
      double settled_s = 0.0;
      const Loop loop(plant, gains, 0.001, part * plant.loaded_inertia_kg_m2, plant.gear_efficiency);
      // A double pole with the zero of the PI controller overshoots by at most e^-2 = 13.5 %.
      EXPECT_LT(overshoot(loop, gains, 0.001, settled_s), part <= 1.0 ? 0.14 : 0.22) << each.robot << ", " << part;
      EXPECT_LT(settled_s, 10.0 / gains.wheel_rate_per_s * (1.0 + part)) << each.robot << ", " << part;
    }
  }
}

TEST(WheelLoop, RefusesAPeriodThatIsTooLongAndNamesTheLongest) {
  for (const WheelCase& each : kWheelCases) {
    const WheelLoopPlant plant = plant_of(each);
    const double longest_s = longest_loop_period_s(plant);
    const WheelLoopGains at_longest = wheel_loop_gains(plant, longest_s);
    EXPECT_NEAR(at_longest.wheel_gain_V_s_per_rad, 0.5 * plant.back_emf_V_s_per_rad, 1e-9) << each.robot;
    try {
      wheel_loop_gains(plant, 1.001 * longest_s);
      ADD_FAILURE() << "no failure";
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      char text[32];
      std::snprintf(text, sizeof text, "at most %.3g ms", 1e3 * longest_s);
      EXPECT_NE(failure.message().find(text), std::string::npos) << failure.message();
    }
  }
}

// Hand calculation for four wheels at right angles: Σt_x² = 2, so m·r²/2 in either direction.
TEST(WheelLoop, MassBehindAWheelOfASquareRobot) {
  robot::Robot robot = twente();
  robot.wheels.axis_rad = {-0.25 * std::numbers::pi, 0.25 * std::numbers::pi, 0.75 * std::numbers::pi, -0.75 * std::numbers::pi};
  const motor::MotorValues motor = ecx_32().nominal;
  const WheelLoopPlant plant = wheel_loop_plant(make_body_with_known_friction(robot, motor), robot::drive_constants(robot, motor));
  EXPECT_NEAR(plant.hardest_body_inertia_kg_m2, 2.632 * 0.028 * 0.028 / 2.0, 1e-9);
  EXPECT_NEAR(plant.wheel_inertia_kg_m2, 220e-7 + 9.47e-7, 1e-12);
  EXPECT_NEAR(plant.loaded_inertia_kg_m2, plant.wheel_inertia_kg_m2 + 2.632 * 0.028 * 0.028 / 4.0, 1e-9);
  EXPECT_NEAR(plant.volt_per_Nm, 1.08 / 0.0328, 1e-9);
}

}  // namespace
}  // namespace heatsoak::firmware
