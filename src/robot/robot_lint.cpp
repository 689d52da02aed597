#include "robot/robot_lint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <optional>

#include "input/document.h"
#include "robot/assumed_friction.h"
#include "robot/body.h"

namespace heatsoak::robot {
namespace {

using motor::LintClause;
using motor::LintWords;

motor::LintFinding finding(const Robot& robot, motor::LintFinding::Level level, std::string_view check, std::string_view key,
                           LintClause what) {
  return {level, std::string(check), std::move(what), input::place_of(robot.file, std::string(key)), std::string(key)};
}

LintClause in_mm(double length_m) { return {LintWords::length, {1e3 * length_m}}; }

/// Returns the smallest angle between the axles of two wheels.
double closest_axles_rad(const Robot& robot) {
  std::vector<double> sorted_rad;
  for (const double each_rad : robot.wheels.axis_rad) {
    sorted_rad.push_back(std::remainder(each_rad, 2.0 * std::numbers::pi));
  }
  std::ranges::sort(sorted_rad);
  double closest_rad = sorted_rad.front() + 2.0 * std::numbers::pi - sorted_rad.back();
  for (std::size_t i = 1; i < sorted_rad.size(); ++i) {
    closest_rad = std::min(closest_rad, sorted_rad[i] - sorted_rad[i - 1]);
  }
  return closest_rad;
}

/// Wheels are discs that touch the contact circle; two of them overlap if their radius reaches the intersection of their planes.
void check_wheels(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  const double room_m = robot.wheels.contact_radius_m * std::tan(0.5 * std::min(closest_axles_rad(robot), 0.9 * std::numbers::pi));
  // Known robots have wheels of 0.35 to 0.42 of the contact radius.
  constexpr double kLargestShare = 0.6;
  constexpr double kSameDirection_rad = 1e-3;
  if (closest_axles_rad(robot) < kSameDirection_rad) {
    findings.push_back(finding(robot, motor::LintFinding::Level::error, "axes", "wheels.axis_angles", LintClause{LintWords::same_angle}));
    return;
  }
  constexpr double kSmallestShare = 0.25;
  if (robot.wheels.radius_m < kSmallestShare * robot.wheels.contact_radius_m) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "wheels", "wheels.contact_radius",
                               LintClause{LintWords::contact_radius_large,
                                          {in_mm(robot.wheels.contact_radius_m), in_mm(robot.wheels.radius_m),
                                           in_mm(robot.wheels.radius_m / kSmallestShare), in_mm(robot.wheels.contact_radius_m)}}));
  }
  const bool is_overlap = robot.wheels.radius_m > room_m;
  if (is_overlap || robot.wheels.radius_m > kLargestShare * robot.wheels.contact_radius_m) {
    findings.push_back(
        finding(robot, is_overlap ? motor::LintFinding::Level::error : motor::LintFinding::Level::warning, "wheels", "wheels.radius",
                LintClause{LintWords::wheels_too_large,
                           {in_mm(robot.wheels.radius_m), LintClause{is_overlap ? LintWords::overlap : LintWords::are_large},
                            in_mm(robot.wheels.contact_radius_m), in_mm(std::min(room_m, kLargestShare * robot.wheels.contact_radius_m)),
                            in_mm(robot.wheels.radius_m)}}));
  }
}

void check_battery(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  const auto add = [&](const char* key, LintClause what) {
    findings.push_back(finding(robot, motor::LintFinding::Level::error, "battery", key, std::move(what)));
  };
  const RobotBattery& battery = robot.battery;
  if (battery.full_V && battery.nominal_V > *battery.full_V) {
    add("battery.nominal_voltage", LintClause{LintWords::nominal_above_full, {battery.nominal_V, *battery.full_V}});
  }
  if (battery.empty_V && battery.nominal_V < *battery.empty_V) {
    add("battery.nominal_voltage", LintClause{LintWords::nominal_below_empty, {battery.nominal_V, *battery.empty_V}});
  }
  if (battery.empty_V && battery.full_V && *battery.empty_V >= *battery.full_V) {
    add("battery.empty_voltage", LintClause{LintWords::empty_above_full, {*battery.empty_V, *battery.full_V}});
  }
}

/// The cells' voltages are optional, so the nominal voltage is also compared with those of small robots.
void check_voltage(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  // Extra-low voltage ends at 60 V; small robots have 3 to 14 LiPo cells.
  constexpr double kMost_V = 60.0;
  if (robot.battery.nominal_V > kMost_V) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "battery", "battery.nominal_voltage",
                               LintClause{LintWords::voltage_above_small_robots, {robot.battery.nominal_V, kMost_V}}));
  }
}

void check_drive(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  const auto add = [&](const char* key, LintClause what) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "drive", key, std::move(what)));
  };
  const std::optional<double> limit_V = robot.drive.voltage_limit_V;
  if (limit_V && robot.battery.full_V && *limit_V > 1.1 * *robot.battery.full_V) {
    add("drive.voltage_limit", LintClause{LintWords::voltage_limit_above_full, {*limit_V, *robot.battery.full_V}});
  }
  // Known robots have ratios of 1 to 5.
  constexpr double kSmallestRatio = 0.5;
  if (robot.drive.gear_ratio < kSmallestRatio) {
    add("drive.gear_ratio", LintClause{LintWords::gear_ratio_small, {robot.drive.gear_ratio, kSmallestRatio}});
  }
  constexpr double kLargestRatio = 30.0;
  if (robot.drive.gear_ratio > kLargestRatio) {
    add("drive.gear_ratio", LintClause{LintWords::gear_ratio_large, {robot.drive.gear_ratio, kLargestRatio}});
  }
}

/// Compares the mean density of the cylinder around the robot with that of known robots, which have 500 to 900 kg/m3.
void check_mass(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  // A robot of the Small Size League has at most 180 mm diameter and 150 mm height; its wheels touch the ground at 80 mm.
  constexpr double kRadius_ratio = 90.0 / 80.0;
  constexpr double kHeight_ratio = 150.0 / 180.0;
  // Batteries and motors have 2000 to 8000 kg/m3, but fill less than a third of a robot.
  constexpr double kMost_kg_per_m3 = 1500.0;
  const double diameter_m = 2.0 * kRadius_ratio * robot.wheels.contact_radius_m;
  const double volume_m3 = 0.25 * std::numbers::pi * diameter_m * diameter_m * kHeight_ratio * diameter_m;
  if (robot.mass_kg > kMost_kg_per_m3 * volume_m3) {
    findings.push_back(
        finding(robot, motor::LintFinding::Level::warning, "mass", "mass",
                LintClause{LintWords::mass_large,
                           {robot.mass_kg, robot.mass_kg / volume_m3, in_mm(diameter_m), kMost_kg_per_m3, kMost_kg_per_m3 * volume_m3}}));
  }
}

/// A disc with the contact radius has 0.5 of mass times radius squared, a ring of twice the radius has 4.
void check_inertia(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  constexpr double kLeast = 0.15;
  constexpr double kMost = 4.0;
  if (!robot.body.yaw_inertia_kg_m2) {
    return;
  }
  const double share = *robot.body.yaw_inertia_kg_m2 / (robot.mass_kg * robot.wheels.contact_radius_m * robot.wheels.contact_radius_m);
  if (share < kLeast || share > kMost) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "inertia", "body.yaw_inertia",
                               LintClause{LintWords::yaw_inertia, {share, kLeast, kMost}}));
  }
}

/// Values that are possible, but far from those of small robots, and so probably in another unit.
void check_motion(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  const auto add = [&](const char* key, LintClause what) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "motion", key, std::move(what)));
  };
  constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
  if (std::ranges::any_of(robot.wheels.axis_rad, [](double each_rad) { return std::abs(each_rad) > kFullTurn_rad; })) {
    add("wheels.axis_angles", LintClause{LintWords::angle_above_turn});
  }
  // A solid disc has 0.5 of mass times radius squared; a wheel of an omni robot weighs less than a tenth of the robot.
  constexpr double kLargestInertia_share = 0.05;
  const double own_kg_m2 = robot.mass_kg * robot.wheels.radius_m * robot.wheels.radius_m;
  if (robot.wheels.inertia_kg_m2 && *robot.wheels.inertia_kg_m2 > kLargestInertia_share * own_kg_m2) {
    add("wheels.inertia", LintClause{LintWords::wheel_inertia, {*robot.wheels.inertia_kg_m2 / own_kg_m2, kLargestInertia_share}});
  }
  if (robot.body.center_of_gravity_height_m && *robot.body.center_of_gravity_height_m > 3.0 * robot.wheels.contact_radius_m) {
    add("body.center_of_gravity_height", LintClause{LintWords::center_of_gravity_high,
                                                    {in_mm(*robot.body.center_of_gravity_height_m), in_mm(robot.wheels.contact_radius_m)}});
  }
  // Wheels that resist with a fifth of the weight on them would not roll; known robots lose 1 to 3 % of it.
  constexpr double kLargestFriction_share = 0.2;
  const double weight_Nm = robot.mass_kg * kGravity_m_per_s2 * robot.wheels.radius_m / static_cast<double>(robot.wheels.axis_rad.size());
  if (robot.friction.wheel_torque_Nm && *robot.friction.wheel_torque_Nm > kLargestFriction_share * weight_Nm) {
    add("friction.wheel_torque",
        LintClause{LintWords::wheel_torque_large,
                   {1e3 * *robot.friction.wheel_torque_Nm, *robot.friction.wheel_torque_Nm / weight_Nm, kLargestFriction_share}});
  }
  constexpr double kFastest_m_per_s = 10.0;
  if (robot.limits.speed_m_per_s && *robot.limits.speed_m_per_s > kFastest_m_per_s) {
    add("limits.speed", LintClause{LintWords::speed_large, {*robot.limits.speed_m_per_s, kFastest_m_per_s}});
  }
  // A planner that needs seconds for its acceleration never reaches it on a field of 12 m.
  constexpr double kSlowest_s = 2.0;
  if (robot.limits.jerk_m_per_s3 && robot.limits.acceleration_m_per_s2 &&
      *robot.limits.acceleration_m_per_s2 > kSlowest_s * *robot.limits.jerk_m_per_s3) {
    add("limits.jerk", LintClause{LintWords::jerk_small,
                                  {*robot.limits.jerk_m_per_s3, *robot.limits.acceleration_m_per_s2,
                                   *robot.limits.acceleration_m_per_s2 / *robot.limits.jerk_m_per_s3, kSlowest_s}});
  }
  // Grip limits wheels on carpet to about 10 m/s2.
  constexpr double kMost_m_per_s2 = 30.0;
  for (const auto& [key, value] :
       {std::pair{"limits.acceleration", robot.limits.acceleration_m_per_s2}, std::pair{"limits.braking", robot.limits.braking_m_per_s2}}) {
    if (value && *value > kMost_m_per_s2) {
      add(key, LintClause{LintWords::acceleration_large, {*value, kMost_m_per_s2}});
    }
  }
}

}  // namespace

std::vector<motor::LintFinding> implausible_values(const Robot& robot) {
  std::vector<motor::LintFinding> findings;
  check_wheels(robot, findings);
  check_battery(robot, findings);
  check_voltage(robot, findings);
  check_drive(robot, findings);
  check_mass(robot, findings);
  check_inertia(robot, findings);
  check_motion(robot, findings);
  return findings;
}

void require_sound(const Robot& robot) {
  base::Diagnostics diagnostics;
  for (const motor::LintFinding& each : implausible_values(robot)) {
    if (each.level == motor::LintFinding::Level::error) {
      diagnostics.add(each.at, each.key, motor::message_of(each));
    }
  }
  diagnostics.throw_if_any();
}

Robot read_sound_robot(const std::filesystem::path& path) {
  Robot robot = read_robot(path);
  require_sound(robot);
  return robot;
}

namespace {

/// Adds notes about the values of these tables that the robot lacks; `why` follows each.
void add_lacking(const Robot& robot, std::span<const std::string_view> tables, LintWords why, std::vector<motor::LintFinding>& findings) {
  try {
    require_parameters(robot, tables);
  } catch (const base::Failure& failure) {
    for (const base::Diagnostic& each : failure.diagnostics()) {
      findings.push_back(finding(robot, motor::LintFinding::Level::note, "motion", each.key,
                                 LintClause{LintWords::missing_value, {each.message, LintClause{why}}}));
    }
  }
}

/// Adds notes about all values that a match needs. Throws the failure of make_body() if the file gives the body, but no robot results.
void add_missing_values(const Robot& robot, std::vector<motor::LintFinding>& findings) {
  constexpr std::array<std::string_view, 4> kMatch{"body", "wheels", "traction", "limits"};
  constexpr std::array<std::string_view, 2> kClosedLoop{"drive", "battery"};
  constexpr std::array<std::string_view, 1> kFriction{"friction"};
  if (std::ranges::any_of(robot.parameters, [](const auto& each) { return each.first.starts_with("body."); })) {
    motor::MotorValues any;
    any.rotor_inertia_kg_m2 = 0.0;
    make_body(with_assumed_friction(robot), any);
  }
  add_lacking(robot, kMatch, LintWords::match_needs_it, findings);
  if (has_friction(robot)) {
    add_lacking(robot, kFriction, LintWords::match_needs_it, findings);
  } else {
    findings.push_back(finding(robot, motor::LintFinding::Level::note, "motion", "friction", LintClause{LintWords::friction_missing}));
  }
  add_lacking(robot, kClosedLoop, LintWords::closed_loop_needs_it, findings);
}

/// Returns what is wrong with the name of the robot's motor, if anything.
std::optional<LintClause> unknown_motor(const Robot& robot, std::span<const std::string> known_motors) {
  if (robot.drive.motor_file) {
    std::error_code error;
    const bool is_there = std::filesystem::exists(*robot.drive.motor_file, error);
    return is_there ? std::nullopt : std::optional(LintClause{LintWords::no_motor_file, {robot.drive.motor_name()}});
  }
  if (robot.drive.motor == "none" || std::ranges::find(known_motors, robot.drive.motor) != known_motors.end()) {
    return std::nullopt;
  }
  return LintClause{LintWords::unknown_motor, {robot.drive.motor, base::did_you_mean(robot.drive.motor, known_motors)}};
}

}  // namespace

std::vector<motor::LintFinding> lint(const Robot& robot, std::span<const std::string> known_motors) {
  std::vector<motor::LintFinding> findings;
  if (std::optional<LintClause> unknown = unknown_motor(robot, known_motors)) {
    findings.push_back(finding(robot, motor::LintFinding::Level::warning, "motor", "drive.motor", std::move(*unknown)));
  }
  std::ranges::move(implausible_values(robot), std::back_inserter(findings));
  add_missing_values(robot, findings);
  return findings;
}

}  // namespace heatsoak::robot
