#include "firmware/friction_voltage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "robot/assumed_friction.h"
#include "robot/inverse_dynamics.h"
#include "robot/motor_drive.h"

namespace heatsoak::firmware {
namespace {

constexpr int kHeadings = 72;
/// Smallest |sin(θ + φ)| at which a wheel counts as rolling; below it the sign of its friction is undefined.
constexpr double kNoRolling = 1e-6;

/// Returns the body for slow motion with settled signs: without damping, smoothing or traction limit.
robot::BodyConfig at_low_speed(robot::BodyConfig body) {
  constexpr double kNarrow = 1e-9;
  body.friction.wheel_damping_Nm_s_per_rad = 0.0;
  body.friction.smoothing_rad_per_s = kNarrow;
  body.traction.roller_speed_m_per_s = kNarrow;
  body.traction.traction_ratio = 1e6;
  return body;
}

struct Sample {
  double heading_rad = 0.0;
  robot::PerWheel voltage_V{};
};

/// Returns the voltage of each wheel over the direction of travel, without back-EMF. Headings are offset by half a step to avoid those at
/// which a wheel stands still.
std::vector<Sample> steady_voltages(const robot::Robot& robot, const robot::DriveConstants& drive, const robot::BodyConfig& body) {
  constexpr double kSpeed_m_per_s = 0.1;
  const robot::BodyConfig slow = at_low_speed(body);
  std::vector<Sample> samples(kHeadings);
  for (int h = 0; h < kHeadings; ++h) {
    Sample& sample = samples[static_cast<std::size_t>(h)];
    sample.heading_rad = 2.0 * std::numbers::pi * (h + 0.5) / kHeadings;
    robot::BodyMotion motion;
    motion.velocity = {kSpeed_m_per_s * std::cos(sample.heading_rad), kSpeed_m_per_s * std::sin(sample.heading_rad), 0.0};
    const robot::WheelDemands wheels = robot::inverse_dynamics(slow, motion);
    for (int i = 0; i < body.kinematics.wheel_count; ++i) {
      const double factor = robot::shaft_torque_factor(robot, wheels.torque_Nm[i] * wheels.speed_rad_per_s[i] >= 0.0);
      const double drag_Nm = std::copysign(drive.drag_torque_Nm, wheels.speed_rad_per_s[i]);
      sample.voltage_V[i] = (wheels.torque_Nm[i] * factor + drag_Nm) * drive.resistance_ohm / drive.torque_constant_Nm_per_A;
    }
  }
  return samples;
}

/// A wheel's sin(θ + φ) and its voltage, at a heading at which it rolls.
struct Point {
  double sine = 0.0;
  double voltage_V = 0.0;
};

std::vector<Point> points_of(const std::vector<Sample>& samples, int wheel, double phase_rad) {
  std::vector<Point> points;
  for (const Sample& each : samples) {
    const double sine = std::sin(each.heading_rad + phase_rad);
    if (std::abs(sine) > kNoRolling) {
      points.push_back({sine, each.voltage_V[wheel]});
    }
  }
  return points;
}

/// Solves the normal equations of min Σ(V − a·s − b·sign s)². The columns s and sign s are never collinear on these headings.
void fit(const std::vector<Point>& points, double& sine_V, double& sign_V) {
  double ss = 0.0;
  double s1 = 0.0;
  double sv_V = 0.0;
  double signed_V = 0.0;
  for (const Point& each : points) {
    ss += each.sine * each.sine;
    s1 += std::abs(each.sine);
    sv_V += each.sine * each.voltage_V;
    signed_V += each.sine > 0.0 ? each.voltage_V : -each.voltage_V;
  }
  const auto count = static_cast<double>(points.size());
  const double determinant = ss * count - s1 * s1;
  sine_V = (sv_V * count - signed_V * s1) / determinant;
  sign_V = (signed_V * ss - sv_V * s1) / determinant;
  // The drive core rejects friction that would drive a wheel near the heading at which its sign changes.
  if (sign_V < 0.0) {
    sign_V = 0.0;
    sine_V = sv_V / ss;
  }
}

double residual_rms_V(const std::vector<Point>& points, double sine_V, double sign_V) {
  double squares_V2 = 0.0;
  for (const Point& each : points) {
    const double left_V = each.voltage_V - sine_V * each.sine - (each.sine > 0.0 ? sign_V : -sign_V);
    squares_V2 += left_V * left_V;
  }
  return std::sqrt(squares_V2 / static_cast<double>(points.size()));
}

}  // namespace

robot::BodyConfig make_body_with_known_friction(const robot::Robot& robot, const motor::MotorValues& motor) {
  if (robot::has_friction(robot)) {
    return robot::make_body(robot, motor);
  }
  robot::Robot smooth = robot;
  smooth.friction.rolling_efficiency.reset();
  smooth.friction.wheel_torque_Nm = 0.0;
  smooth.friction.wheel_damping_Nm_s_per_rad = 0.0;
  smooth.friction.roller_drag_ratio = 0.0;
  return robot::make_body(smooth, motor);
}

FrictionVoltage friction_voltage(const robot::Robot& robot, const motor::MotorValues& motor) {
  const robot::BodyConfig body = make_body_with_known_friction(robot, motor);
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  const double geared_Nm_per_A = drive.torque_constant_Nm_per_A * drive.gear_ratio;
  const double volt_per_Nm = drive.resistance_ohm / (geared_Nm_per_A * drive.gear_efficiency);
  const double drag_V = drive.drag_torque_Nm * drive.resistance_ohm / drive.torque_constant_Nm_per_A;
  const robot::FrictionConfig& friction = body.friction;
  FrictionVoltage made;
  made.damping_V_s_per_rad = geared_Nm_per_A + friction.wheel_damping_Nm_s_per_rad * volt_per_Nm;
  made.is_known = robot::has_friction(robot);
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const robot::Direction& offset = friction.heading.phase_offset[i];
    made.phase_rad[i] = robot::rolling_phase_rad(body.kinematics.wheels[i]) + std::atan2(offset.sine_ratio, offset.cosine_ratio);
  }
  if (!made.is_known) {
    return made;
  }
  made.rotation_V = (friction.by_heading ? friction.heading.rotation_Nm : friction.wheel_torque_Nm) * volt_per_Nm + drag_V;
  const std::vector<Sample> samples = steady_voltages(robot, drive, body);
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const std::vector<Point> points = points_of(samples, i, made.phase_rad[i]);
    if (friction.by_heading && friction.heading.double_angle_Nm == 0.0) {
      made.sine_V[i] = friction.heading.sine_Nm[i] * volt_per_Nm;
      made.sign_V[i] = friction.heading.constant_Nm[i] * volt_per_Nm + drag_V;
    } else {
      fit(points, made.sine_V[i], made.sign_V[i]);
    }
    made.residual_rms_V[i] = residual_rms_V(points, made.sine_V[i], made.sign_V[i]);
  }
  return made;
}

}  // namespace heatsoak::firmware
