#include "friction/read_friction_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/unknown.h"
#include "recording/quantities.h"

namespace heatsoak::friction {
namespace {

using Column = std::vector<double>;

class ColumnsOfRobot {
 public:
  ColumnsOfRobot(const recording::Recording& recording, const robot::Robot& robot, const FrictionLogNeeds& needs,
                 FrictionFindings& findings)
      : recording_(recording), robot_(robot), needs_(needs), findings_(findings) {}

  FrictionLog log() {
    FrictionLog log;
    log.name = recording_.name;
    log.time_s = recording_.time_s;
    log.run_begins = recording_.run_begins;
    std::vector<std::size_t> without_speed;
    for (std::size_t wheel = 0; wheel < robot_.wheels.axis_rad.size(); ++wheel) {
      if (const Column* speed = numbered("wheel_speed_rad_per_s", wheel)) {
        log.wheel_speed_rad_per_s[wheel] = *speed;
        std::ranges::for_each(log.wheel_speed_rad_per_s[wheel], [&](double& each) { each /= robot_.drive.gear_ratio; });
      } else {
        without_speed.push_back(wheel);
      }
    }
    if (needs_.all_wheels || without_speed.size() == robot_.wheels.axis_rad.size()) {
      for (const std::size_t wheel : without_speed) {
        missing(fmt::format("wheel_speed_rad_per_s_{}", wheel + 1), "speed of the wheel's motor");
      }
    }
    add_voltages(log);
    diagnostics_.throw_if_any();
    if (!needs_.direction) {
      return log;
    }
    if (const Column* yaw = column("yaw_rad")) {
      log.yaw_rad = *yaw;
    }
    log.heading_rad = heading_rad(log);
    return log;
  }

 private:
  [[nodiscard]] const Column* column(std::string_view key) const {
    const recording::Channel* channel = recording_.find(key);
    return channel ? &channel->values : nullptr;
  }
  [[nodiscard]] const Column* numbered(std::string_view key, std::size_t wheel) const {
    return column(fmt::format("{}_{}", key, wheel + 1));
  }
  void missing(const std::string& key, const std::string& meaning) {
    diagnostics_.add({recording_.file.string(), 1, 1}, key, fmt::format("is missing: {}; the log or its mapping must name it", meaning));
  }
  void note(const FrictionFinding& finding) {
    if (std::ranges::find(findings_, finding) == findings_.end()) {
      findings_.push_back(finding);
    }
  }

  void add_voltages(FrictionLog& log) {
    for (std::size_t wheel = 0; wheel < robot_.wheels.axis_rad.size(); ++wheel) {
      if (const Column* voltage = numbered("wheel_voltage_V", wheel)) {
        log.voltage_V[wheel] = *voltage;
        note(VoltageFrom{VoltageFrom::Source::log});
      } else if (const Column* modulation = numbered("wheel_modulation_ratio", wheel)) {
        log.voltage_V[wheel] = modulated(*modulation);
      } else if (const Column* current = numbered("wheel_current_A", wheel);
                 current && needs_.drive && !log.wheel_speed_rad_per_s[wheel].empty()) {
        log.voltage_V[wheel] = of_current(*current, log.wheel_speed_rad_per_s[wheel]);
      } else if (needs_.voltage) {
        missing(fmt::format("wheel_modulation_ratio_{}", wheel + 1),
                current ? "modulation; a current can replace it only if --motor gives the motor's resistance and torque constant"
                        : "modulation (or wheel_voltage_V, wheel_current_A)");
      }
    }
  }

  Column modulated(const Column& modulation) {
    const Column* battery = column("battery_V") ? column("battery_V") : column(recording::column_of(base::Signal::bus_voltage));
    note(battery ? VoltageFrom{VoltageFrom::Source::modulation}
                 : VoltageFrom{VoltageFrom::Source::modulation_with_nominal_battery, robot_.battery.nominal_V});
    Column voltage_V = modulation;
    for (std::size_t row = 0; row < voltage_V.size(); ++row) {
      voltage_V[row] *= battery ? (*battery)[row] : robot_.battery.nominal_V;
    }
    return voltage_V;
  }

  /// True if all currents are non-negative although wheels turn in both directions: the log has only magnitudes.
  [[nodiscard]] bool has_sizes_only() const {
    bool turns_back = false;
    for (std::size_t wheel = 0; wheel < robot_.wheels.axis_rad.size(); ++wheel) {
      const Column* current = numbered("wheel_current_A", wheel);
      if (current && std::ranges::any_of(*current, [](double each) { return each < 0.0; })) {
        return false;
      }
      const Column* speed = numbered("wheel_speed_rad_per_s", wheel);
      turns_back = turns_back || (speed != nullptr && std::ranges::any_of(*speed, [](double each) { return each < 0.0; }));
    }
    return turns_back;
  }

  Column of_current(const Column& current, const Column& wheel_speed_rad_per_s) {
    const bool sizes_only = has_sizes_only();
    note(VoltageFrom{sizes_only ? VoltageFrom::Source::current_without_sign : VoltageFrom::Source::current});
    Column voltage_V(current.size());
    for (std::size_t row = 0; row < current.size(); ++row) {
      const double speed_rad_per_s = wheel_speed_rad_per_s[row];
      const double current_A = sizes_only ? std::copysign(speed_rad_per_s == 0.0 ? 0.0 : current[row], speed_rad_per_s) : current[row];
      voltage_V[row] =
          needs_.drive->resistance_ohm * current_A + needs_.drive->torque_constant_Nm_per_A * needs_.drive->gear_ratio * speed_rad_per_s;
    }
    return voltage_V;
  }

  /// Directions of a velocity with components x and y; NaN if both are 0.
  static Column directions_rad(const Column& x, const Column& y) {
    Column direction_rad(x.size());
    for (std::size_t row = 0; row < x.size(); ++row) {
      direction_rad[row] = x[row] == 0.0 && y[row] == 0.0 ? base::kUnknown : std::atan2(y[row], x[row]);
    }
    return direction_rad;
  }

  [[nodiscard]] Column direction_rad(std::string_view x, std::string_view y) const {
    const Column* along = column(x);
    const Column* across = column(y);
    return along && across ? directions_rad(*along, *across) : Column{};
  }

  /// Converts directions from the field's frame to the robot's. Throws Failure (bad_input) if the log has no yaw_rad.
  Column turned(Column direction_rad, const FrictionLog& log) {
    if (direction_rad.empty()) {
      return direction_rad;
    }
    if (log.yaw_rad.empty()) {
      diagnostics_.add({recording_.file.string(), 1, 1}, "yaw_rad",
                       "is missing: directions on the field are known, but not the orientation of the robot");
      diagnostics_.throw_if_any();
    }
    for (std::size_t row = 0; row < direction_rad.size(); ++row) {
      direction_rad[row] -= log.yaw_rad[row];
    }
    return direction_rad;
  }

  Column commanded_rad(const FrictionLog& log) {
    if (const Column* heading = column("heading_rad")) {
      return *heading;
    }
    if (const Column* heading = column("heading_field_rad")) {
      return turned(*heading, log);
    }
    Column found = direction_rad("vx_set_m_per_s", "vy_set_m_per_s");
    return found.empty() ? turned(direction_rad("vx_field_set_m_per_s", "vy_field_set_m_per_s"), log) : found;
  }

  Column measured_rad(const FrictionLog& log) {
    Column found = direction_rad("vx_m_per_s", "vy_m_per_s");
    return found.empty() ? turned(direction_rad("vx_field_m_per_s", "vy_field_m_per_s"), log) : found;
  }

  Column heading_rad(const FrictionLog& log) {
    const bool any = needs_.direction == TravelDirection::best;
    if (any || needs_.direction == TravelDirection::commanded) {
      if (Column found = commanded_rad(log); !found.empty()) {
        note(DirectionFrom{DirectionFrom::Source::commanded});
        return found;
      }
    }
    if (any || needs_.direction == TravelDirection::measured) {
      if (Column found = measured_rad(log); !found.empty()) {
        note(DirectionFrom{DirectionFrom::Source::measured});
        return found;
      }
    }
    if (!any && needs_.direction != TravelDirection::wheels) {
      missing(needs_.direction == TravelDirection::commanded ? "heading_rad" : "vx_m_per_s", "direction of travel");
      diagnostics_.throw_if_any();
    }
    note(DirectionFrom{DirectionFrom::Source::wheels});
    return {};
  }

  const recording::Recording& recording_;
  const robot::Robot& robot_;
  const FrictionLogNeeds& needs_;
  FrictionFindings& findings_;
  base::Diagnostics diagnostics_;
};

}  // namespace

FrictionLog friction_log(const recording::Recording& recording, const robot::Robot& robot, const FrictionLogNeeds& needs,
                         FrictionFindings& findings) {
  return ColumnsOfRobot(recording, robot, needs, findings).log();
}

std::size_t last_wheel(const recording::Recording& recording) {
  std::size_t last = 0;
  for (const recording::Channel& channel : recording.channels) {
    const std::string_view key = channel.quantity.key;
    for (const std::string_view stem : {"wheel_speed_rad_per_s_", "wheel_voltage_V_", "wheel_modulation_ratio_", "wheel_current_A_"}) {
      std::size_t wheel = 0;
      if (key.starts_with(stem)) {
        std::from_chars(key.data() + stem.size(), key.data() + key.size(), wheel);
      }
      if (wheel > last && std::ranges::any_of(channel.values, [](double each) { return std::abs(each) > 0.0; })) {
        last = wheel;
      }
    }
  }
  return last;
}

}  // namespace heatsoak::friction
