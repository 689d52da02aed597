// A robot that drives the steady-state test, simulated by the plant's forward dynamics. It has wheel-speed controllers on a sagging
// battery, homing between legs, and pushes that make wheels slip. Its logger adds noise, quantisation and bad rows.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "friction/friction_log.h"
#include "robot/plant.h"

namespace heatsoak::friction {

struct TestDrive {
  std::vector<double> headings_rad;
  std::vector<double> speeds_m_per_s;
  double yaw_rad = 0.4;  ///< constant yaw on the field
  double hold_s = 2.5;   ///< duration of a leg at its speed
  double push_N = 0.1;   ///< standard deviation of a steady push, drawn for each leg
  double bad_row_share = 0.0;
  bool rotates = false;  ///< adds legs of pure rotation at the end
};

/// A row in the logger's format; the heading is that of the command on the field.
struct DriveRow {
  double time_s = 0.0;
  robot::PerWheel wheel_speed_rad_per_s{};
  robot::PerWheel pwm_ratio{};
  double battery_V = 0.0;
  double command_heading_rad = 0.0;
  double yaw_rad = 0.0;
};

class DriveOnPlant {
 public:
  DriveOnPlant(const robot::PlantConfig& plant, const TestDrive& drive, std::uint64_t seed)
      : plant_(plant), drive_(drive), state_(robot::plant_at_rest(plant)), engine_(seed) {
    state_.pose.yaw_rad = drive.yaw_rad;
  }

  std::vector<DriveRow> rows() {
    for (const double speed_m_per_s : drive_.speeds_m_per_s) {
      for (const double heading_rad : drive_.headings_rad) {
        push_ = {drive_.push_N * normal_(engine_), drive_.push_N * normal_(engine_), 0.0};
        outward(speed_m_per_s, heading_rad + drive_.yaw_rad);
        home();
      }
    }
    for (const double speed_m_per_s : drive_.rotates ? drive_.speeds_m_per_s : std::vector<double>{}) {
      for (const double side : {1.0, -1.0}) {
        for (double time_s = 0.0; time_s < drive_.hold_s; time_s += kPeriod_s) {
          follow({0.0, 0.0, side * speed_m_per_s / plant_.body.kinematics.contact_radius_m}, 0.0);
        }
        drive_.yaw_rad = state_.pose.yaw_rad;
        stand();
      }
    }
    spoil();
    return rows_;
  }

 private:
  static constexpr double kPeriod_s = 0.01;
  static constexpr double kAcceleration_m_per_s2 = 3.0;
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  void outward(double speed_m_per_s, double heading_rad) {
    const double rise_s = speed_m_per_s / kAcceleration_m_per_s2;
    for (double time_s = 0.0; time_s < 2.0 * rise_s + drive_.hold_s; time_s += kPeriod_s) {
      const double fall_s = 2.0 * rise_s + drive_.hold_s - time_s;
      const double now_m_per_s = speed_m_per_s * std::min({1.0, time_s / rise_s, fall_s / rise_s});
      follow(on_field(now_m_per_s * std::cos(heading_rad), now_m_per_s * std::sin(heading_rad)), heading_rad);
    }
    stand();
  }

  void home() {
    push_ = {};
    for (int n = 0; n < 1000; ++n) {
      const double away_m = std::hypot(state_.pose.x_m, state_.pose.y_m);
      if (away_m < 0.02) {
        break;
      }
      const double speed_m_per_s = std::min({0.8, 3.0 * away_m, kAcceleration_m_per_s2 * kPeriod_s * (n + 1)});
      const double heading_rad = std::atan2(-state_.pose.y_m, -state_.pose.x_m);
      follow(on_field(speed_m_per_s * std::cos(heading_rad), speed_m_per_s * std::sin(heading_rad)), heading_rad);
    }
    stand();
  }

  void stand() {
    for (int n = 0; n < 25; ++n) {
      follow(on_field(0.0, 0.0), 0.0);
    }
  }

  /// Converts a velocity on the field to the robot's frame; the yaw is constant.
  [[nodiscard]] robot::BodyVelocity on_field(double x_m_per_s, double y_m_per_s) const {
    return robot::to_local(robot::BodyVelocity{x_m_per_s, y_m_per_s, 4.0 * (drive_.yaw_rad - state_.pose.yaw_rad)}, state_.pose.yaw_rad);
  }

  /// Simulates one row: a PI controller for each wheel's speed every millisecond, whose output is the modulation of the measured battery.
  /// The row contains the last modulation and the encoder counts.
  void follow(const robot::BodyVelocity& local, double command_heading_rad) {
    const robot::PerWheel wanted_rad_per_s = robot::wheel_speeds_rad_per_s(plant_.body.kinematics, local);
    DriveRow row{.time_s = time_s_, .command_heading_rad = command_heading_rad};
    row.battery_V = 0.01 * std::round((battery_V_ + 0.05 * normal_(engine_)) / 0.01);
    row.yaw_rad = state_.pose.yaw_rad + 0.005 * normal_(engine_);
    robot::PlantInput input;
    input.external = robot::to_local(push_, state_.pose.yaw_rad);
    robot::PerWheel angle_rad{};
    for (double t_s = 0.0; t_s < kPeriod_s - 1e-9; t_s += plant_.period_s) {
      for (int i = 0; i < plant_.body.kinematics.wheel_count; ++i) {
        const double error_rad_per_s = wanted_rad_per_s[i] - state_.wheel_speed_rad_per_s[i] + 0.05 * normal_(engine_);
        integral_rad_[i] = std::clamp(integral_rad_[i] + error_rad_per_s * plant_.period_s, -2.0, 2.0);
        const double wanted_V = 0.03 * wanted_rad_per_s[i] + 0.3 * error_rad_per_s + 2.0 * integral_rad_[i];
        row.pwm_ratio[i] = std::round(1000.0 * std::clamp(wanted_V / row.battery_V, -0.95, 0.95)) / 1000.0;
        input.command[i] = {robot::MotorCommand::Kind::voltage, row.pwm_ratio[i] * battery_V_};
      }
      battery_V_ = robot::step(plant_, state_, input).battery_V;
      for (int i = 0; i < plant_.body.kinematics.wheel_count; ++i) {
        angle_rad[i] += state_.wheel_speed_rad_per_s[i] * plant_.period_s;
      }
    }
    for (int i = 0; i < plant_.body.kinematics.wheel_count; ++i) {
      const double counts = (angle_rad[i] + 2e-4 * normal_(engine_)) * kCounts_per_rad;
      row.wheel_speed_rad_per_s[i] = std::round(counts) / kCounts_per_rad / kPeriod_s;
    }
    rows_.push_back(row);
    time_s_ += kPeriod_s;
  }

  /// Adds lost rows, spikes, outdated rows and wrong modulation in bursts of one to three.
  void spoil() {
    std::uniform_real_distribution<double> any(0.0, 1.0);
    const std::vector<DriveRow> whole = rows_;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (any(engine_) >= drive_.bad_row_share / 2.0) {
        continue;
      }
      const double kind = any(engine_);
      const std::size_t burst = 1 + static_cast<std::size_t>(3.0 * any(engine_));
      for (std::size_t end = std::min(rows_.size(), i + burst); i < end; ++i) {
        spoil(rows_[i], whole[i > 70 ? i - 70 : 0], kind, any(engine_));
      }
    }
  }

  static void spoil(DriveRow& row, const DriveRow& old, double kind, double size) {
    if (kind < 0.25) {
      row.wheel_speed_rad_per_s.fill(kNaN);
      row.pwm_ratio.fill(kNaN);
    } else if (kind < 0.5) {
      row.wheel_speed_rad_per_s.fill(400.0 * (size - 0.5));
    } else if (kind < 0.75) {
      row.wheel_speed_rad_per_s = old.wheel_speed_rad_per_s;
      row.pwm_ratio = old.pwm_ratio;
    } else {
      row.pwm_ratio.fill(0.0);
    }
  }

  static constexpr double kCounts_per_rad = 8192.0 / (2.0 * std::numbers::pi);

  robot::PlantConfig plant_;
  TestDrive drive_;
  robot::PlantState state_;
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
  robot::Wrench push_;
  robot::PerWheel integral_rad_{};
  double battery_V_ = 24.0;
  double time_s_ = 0.0;
  std::vector<DriveRow> rows_;
};

/// Returns the log in the logger's format; lost values are blank.
inline std::string csv_of(const std::vector<DriveRow>& rows, int wheel_count) {
  std::string text = "time_s,battery_V,heading_field_rad,yaw_rad";
  for (int i = 1; i <= wheel_count; ++i) {
    text += fmt::format(",wheel_speed_rad_per_s_{},wheel_pwm_ratio_{}", i, i);
  }
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format("{:.7g}", value) : std::string(); };
  for (const DriveRow& row : rows) {
    text += fmt::format("\n{:.2f},{:.2f},{:.5f},{:.5f}", row.time_s, row.battery_V, row.command_heading_rad, row.yaw_rad);
    for (int i = 0; i < wheel_count; ++i) {
      text += fmt::format(",{},{}", cell(row.wheel_speed_rad_per_s[i]), cell(row.pwm_ratio[i]));
    }
  }
  return text + "\n";
}

inline FrictionLog log_of(const std::vector<DriveRow>& rows, int wheel_count) {
  FrictionLog log;
  log.run_begins = {0};
  for (const DriveRow& row : rows) {
    log.time_s.push_back(row.time_s);
    log.heading_rad.push_back(row.command_heading_rad - row.yaw_rad);
    log.yaw_rad.push_back(row.yaw_rad);
    for (int i = 0; i < wheel_count; ++i) {
      log.wheel_speed_rad_per_s[static_cast<std::size_t>(i)].push_back(row.wheel_speed_rad_per_s[i]);
      log.voltage_V[static_cast<std::size_t>(i)].push_back(row.pwm_ratio[i] * row.battery_V);
    }
  }
  return log;
}

}  // namespace heatsoak::friction
