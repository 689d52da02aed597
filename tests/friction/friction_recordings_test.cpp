// Friction test on recordings of real robots. The recordings are not part of the project; without them the tests are skipped.
#include <gtest/gtest.h>

#include <iomanip>
#include <iostream>
#include <sstream>

#include "../support/measured_data.h"
#include "friction/friction_fit.h"
#include "friction/read_friction_log.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::friction {
namespace {

FrictionLog log_in_file(const std::filesystem::path& file, const std::string& mapping, const robot::Robot& robot,
                        const FrictionLogNeeds& needs, FrictionFindings& findings) {
  recording::RecordingReport report;
  return friction_log(recording::read_recording(file, recording::mapping_for(file, kSource / "tests/data/mappings" / mapping), report),
                      robot, needs, findings);
}

const robot::Robot& robotino() {
  static const robot::Robot robot = robot::read_robot(kSource / "tests/data/robots/festo_robotino.toml");
  return robot;
}

/// The measured friction torque at the wheel includes the motor's drag; 5.95 Ω, 51.4 mN m/A.
robot::DriveConstants robotino_drive() {
  return {.resistance_ohm = 5.95, .torque_constant_Nm_per_A = 0.0514, .drag_torque_Nm = 0.0, .gear_ratio = 16.0};
}

/// Back-EMF from the data sheet, without friction.
robot::PerWheel back_emf_V(const SteadyPart& part) {
  robot::PerWheel voltage_V{};
  for (int i = 0; i < 3; ++i) {
    voltage_V[i] = robot::steady_voltage_V(robotino_drive(), 0.0, part.wheel_speed_rad_per_s[i]);
  }
  return voltage_V;
}

SteadyParts robotino_parts(const std::filesystem::path& surface, int first, int end, FrictionFindings& findings) {
  std::vector<FrictionLog> logs;
  for (int n = first; n < end; ++n) {
    const std::filesystem::path file = surface / fmt::format("exp{:02}.csv", n);
    logs.push_back(log_in_file(file, "robotino_omni.map.toml", robotino(), {.voltage = true, .drive = robotino_drive()}, findings));
  }
  return find_steady_parts(logs, robot::make_kinematics(robotino()));
}

std::string shown(const std::optional<Estimate>& estimate) {
  std::ostringstream text;
  if (estimate) {
    text << estimate->value;
  }
  if (estimate && estimate->interval) {
    text << " [" << estimate->interval->low << ", " << estimate->interval->high << "]";
  }
  return text.str();
}

void print(const std::string& name, const SteadyParts& steady, const FrictionFit& fit, const HeldOutError& error) {
  std::cout << name << ": " << steady.legs << " legs, " << steady.rows_steady << " of " << steady.rows << " rows steady; on "
            << error.headings << " of " << error.all_headings << " headings " << error.before_V.value_or(NAN) << " V before, "
            << error.after_V.value_or(NAN) << " V after\n";
  for (const WheelFriction& wheel : fit.wheels) {
    std::cout << "  d " << shown(wheel.damping_V_s_per_rad) << "  a " << shown(wheel.sine_V) << "  b " << shown(wheel.constant_V)
              << "  phase " << shown(wheel.phase_rad) << "  R2 " << wheel.r2_ratio.value_or(NAN) << "  " << wheel.parts_used << " legs, "
              << wheel.parts_standing << " standing, " << wheel.parts_outlying << " outlying\n";
  }
}

/// One speed: the back-EMF gives the damping, the directions give the rest. Opposite headings agree within 5 % of Σi².
TEST(FrictionOfRecordings, robotino_on_two_surfaces) {
  SKIP_WITHOUT_MEASURED_DATA("robotino_omni");
  const std::filesystem::path folder = *measured_data("robotino_omni");
  for (const char* surface : {"table_surface", "brown_surface"}) {
    FrictionFindings findings;
    const SteadyParts steady = robotino_parts(folder / surface, 0, 72, findings);
    EXPECT_GE(steady.legs, 65);
    FitSettings settings;
    settings.known_damping_V_s_per_rad = 0.0514 * 16.0;
    const robot::Kinematics kinematics = robot::make_kinematics(robotino());
    const FrictionFit fit = fit_friction(steady.parts, kinematics, settings);
    const HeldOutError error = error_on_held_out_headings(steady.parts, kinematics, settings, back_emf_V);
    print(surface, steady, fit, error);
    EXPECT_EQ(error.headings, 24);
    EXPECT_LT(error.after_V.value(), 0.35 * error.before_V.value());
    // Neighbouring points deviate from the curve in the same direction where a wheel turns slowly.
    EXPECT_TRUE(fit.wheels[0].lack.is_found);
    EXPECT_EQ(fit.wheels[0].lack.repeats, Repeats::neighbouring_headings);
    for (const WheelFriction& wheel : fit.wheels) {
      ASSERT_TRUE(wheel.is_learned()) << testing::PrintToString(wheel.problem);
      EXPECT_TRUE(wheel.damping_is_given);
      EXPECT_GT(wheel.r2_ratio, 0.98);
      // The recordings' robots.md states about 0.15 A to keep a wheel turning, 5.95 Ω.
      EXPECT_NEAR(wheel.constant_V->value, 0.15 * 5.95, 0.5);
    }
  }
}

TEST(FrictionOfRecordings, robotino_on_carpet_at_three_speeds) {
  SKIP_WITHOUT_MEASURED_DATA("robotino_omni");
  const std::filesystem::path folder = *measured_data("robotino_omni");
  FrictionFindings findings;
  const SteadyParts steady = robotino_parts(folder / "green_surface", 0, 216, findings);
  const robot::Kinematics kinematics = robot::make_kinematics(robotino());
  const FrictionFit fit = fit_friction(steady.parts, kinematics, {});
  const HeldOutError error = error_on_held_out_headings(steady.parts, kinematics, {}, back_emf_V);
  print("green_surface", steady, fit, error);
  EXPECT_LT(error.after_V.value(), 0.35 * error.before_V.value());
  for (const WheelFriction& wheel : fit.wheels) {
    ASSERT_TRUE(wheel.is_learned()) << testing::PrintToString(wheel.problem);
    EXPECT_FALSE(wheel.damping_is_given);
    EXPECT_GT(wheel.r2_ratio, 0.98);
    // The damping is at least the back-EMF constant unless friction falls with speed. The measured interval must not contradict this.
    EXPECT_GT(wheel.damping_V_s_per_rad->interval->high, 0.0514 * 16.0);
    EXPECT_GT(wheel.damping_V_s_per_rad->value, 0.95 * 0.0514 * 16.0);
    EXPECT_LT(wheel.damping_V_s_per_rad->value, 1.5 * 0.0514 * 16.0);
  }
}

/// Staircases of modulation on blocks in both directions. The reference is an ordinary line through all rows above 5 rad/s. Back-EMF and
/// battery give 24 V/(60 rad/s per 0.083), about 0.033 V s/rad.
TEST(FrictionOfRecordings, a_team_wheel_motors_voltage_over_speed) {
  SKIP_WITHOUT_MEASURED_DATA("ateam_wheel_motor");
  const std::filesystem::path folder = *measured_data("ateam_wheel_motor");
  robot::Robot robot = robotino();
  robot.wheels.axis_rad = {-0.5, 0.5, 2.4, -2.4};
  robot.drive.gear_ratio = 1.0;
  robot.battery.nominal_V = 24.0;
  FrictionFindings findings;
  std::vector<FrictionLog> logs;
  for (const char* file : {"Model1_pos.csv", "Model2_neg.csv"}) {
    logs.push_back(log_in_file(folder / file, "ateam_wheel_motor.map.toml", robot, {}, findings));
  }
  const SteadyParts steady = find_steady_parts(logs, robot::make_kinematics(robot));
  const FrictionFit fit = fit_friction(steady.parts, robot::make_kinematics(robot), {});
  std::cout << steady.parts.size() << " parts\n";
  for (std::size_t i = 0; i < 4; ++i) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const FrictionLog& log : logs) {
      for (std::size_t row = 0; row < log.rows(); ++row) {
        const double speed = log.wheel_speed_rad_per_s[i][row];
        if (std::abs(speed) > 5.0 && std::isfinite(log.voltage_V[i][row])) {
          const double side = speed > 0.0 ? 1.0 : -1.0;
          n += 1.0;
          x += side * speed;
          y += side * log.voltage_V[i][row];
          xx += speed * speed;
          xy += speed * log.voltage_V[i][row];
        }
      }
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    const double offset_V = (y - slope * x) / n;
    const WheelFriction& wheel = fit.wheels[i];
    ASSERT_TRUE(wheel.is_learned()) << testing::PrintToString(wheel.problem);
    std::cout << "wheel " << i + 1 << ": " << shown(wheel.damping_V_s_per_rad) << " V s/rad, offset " << shown(wheel.rotation_V)
              << " V, R2 " << wheel.r2_ratio.value_or(NAN) << ", legs " << wheel.parts_used << "; line through the rows " << slope << ", "
              << offset_V << "\n";
    EXPECT_NEAR(wheel.damping_V_s_per_rad->value, slope, 0.02 * slope);
    EXPECT_NEAR(wheel.rotation_V->value, offset_V, 0.04);
    EXPECT_GT(wheel.r2_ratio, 0.998);
  }
}

}  // namespace
}  // namespace heatsoak::friction
