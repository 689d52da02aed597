// core_config.h: every value of the configuration with its origin.
#include <embedded/core_sources.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <regex>
#include <sstream>

#include "firmware/core_files.h"

namespace heatsoak::firmware {
namespace {

using Origins = std::map<std::string, std::string, std::less<>>;

/// "robot file: body.yaw_inertia (estimated)".
std::string of_robot(const robot::Robot& robot, std::string_view key) {
  const auto found = robot.parameters.find(key);
  return found == robot.parameters.end() ? fmt::format("robot file: {}", key)
                                         : fmt::format("robot file: {} ({})", key, base::to_string(found->second.origin));
}

std::string of_motor(const motor::Motor& motor, std::string_view key) {
  const auto found = motor.parameters.find(key);
  return found == motor.parameters.end() ? fmt::format("motor file: {}", key)
                                         : fmt::format("motor file: {} ({})", key, base::to_string(found->second.origin));
}

/// Returns the origin of the slip factors, which is the same for all wheels if the file states one.
std::string origin_of_slip(const robot::Robot& robot) {
  if (robot.wheels.slip_factor.empty()) {
    return "1: the robot file has no wheels.slip_factors";
  }
  const auto stated = robot.parameters.find("wheels.slip_factors[0]");
  return stated == robot.parameters.end() ? "robot file: wheels.slip_factors"
                                          : fmt::format("robot file: wheels.slip_factors ({})", base::to_string(stated->second.origin));
}

Origins wheel_origins(bool has_friction, const std::string& slip) {
  return {
      {"rolling_x_share", "robot file: wheels.axis_angles"},
      {"rolling_y_share", "robot file: wheels.axis_angles"},
      {"inverse_x_factor", "pseudo-inverse of the wheels' directions and contact_radius_m"},
      {"inverse_y_factor", "pseudo-inverse of the wheels' directions and contact_radius_m"},
      {"inverse_yaw_per_m", "pseudo-inverse of the wheels' directions and contact_radius_m"},
      {"slip_factor", slip},
      {"level_load_share", "robot file: wheels.axis_angles and the centre of gravity in [body]"},
      {"damping_V_s_per_rad",
       has_friction ? "back-EMF, and robot file: friction.wheel_damping, as voltage" : "back-EMF alone: the robot file has no [friction]"},
      {"sine_V", has_friction ? "robot file: [friction], as voltage of a turning wheel" : "0: the robot file has no [friction]"},
      {"sign_V", has_friction ? "robot file: [friction], as voltage of a turning wheel" : "0: the robot file has no [friction]"},
      {"phase_cosine_ratio", has_friction ? "cosine of the phase of robot file: [friction], or of the rolling direction" : "no friction"},
      {"phase_sine_ratio", has_friction ? "sine of the phase" : "no friction"},
      {"rim_per_speed_m", "wheel_radius_m/slip_factor"},
      {"speed_per_rim_per_m", "slip_factor/wheel_radius_m"},
      {"body_limit_A", "smaller one of current_limit_A and grip on level ground"},
  };
}

Origins body_origins(const CoreSource& source) {
  return {
      {"check_sum", "CRC-32 of what follows, without the pointers: robot_core::config_check_sum()"},
      {"wheel_count", "robot file: wheels.axis_angles"},
      {"period_s", "option --period"},
      {"wheel_radius_m", of_robot(source.robot, "wheels.radius")},
      {"contact_radius_m", of_robot(source.robot, "wheels.contact_radius")},
      {"mass_kg", of_robot(source.robot, "mass")},
      {"yaw_inertia_kg_m2", of_robot(source.robot, "body.yaw_inertia")},
      {"wheel_inertia_kg_m2",
       of_robot(source.robot, "wheels.inertia") + "; " + of_motor(source.motor, "rotor_inertia") + ", times gear_ratio squared"},
      {"torque_constant_Nm_per_A", of_motor(source.motor, "torque_constant")},
      {"resistance_ohm", of_motor(source.motor, "terminal_resistance") + "; " + of_robot(source.robot, "drive.driver_resistance")},
      {"resistance_rise_per_K", "of copper, for the winding's share of resistance_ohm"},
      {"lowest_resistance_ohm", "resistance_ohm at the lower end of the motor's tolerance and in the coldest air"},
      {"gear_ratio", of_robot(source.robot, "drive.gear_ratio")},
      {"gear_efficiency", "robot file: drive.gear_efficiency times friction.rolling_efficiency, 1 where absent"},
      {"fastest_wheel_rad_per_s", "1.1*battery_full_V/(torque constant*gear ratio): 10 % by a push"},
      {"largest_acceleration_rad_per_s2", "of a wheel in the air under current_limit_A"},
      {"battery_full_V", of_robot(source.robot, "battery.full_voltage")},
      {"battery_lowest_V", of_robot(source.robot, "battery.empty_voltage")},
      {"battery_resistance_ohm", of_robot(source.robot, "battery.internal_resistance")},
      {"voltage_limit_V", "robot file: drive.voltage_limit, at most the full battery"},
      {"current_limit_A",
       "robot file: drive.current_limit, at most what battery and back-EMF drive together through lowest_resistance_ohm"},
      {"rotation_friction_V", source.config.has_friction ? "robot file: friction.heading.rotation or friction.wheel_torque, as voltage"
                                                         : "0: the robot file has no [friction]"},
      {"friction_smoothing_m_per_s", "as in the simulated robot"},
      {"has_friction", "robot file: [friction]"},
      {"shadow_mode", source.config.shadow_mode ? "option --shadow: the guard limits nothing" : "off: the guard limits"},
  };
}

Origins control_origins(const CoreSource& source) {
  return {
      {"body_gain_per_s", "a quarter of the wheel loop's bandwidth, or what a wheel in the air allows"},
      {"yaw_gain_per_s", "half of the wheel loop's bandwidth"},
      {"yaw_integral_per_s2", "yaw_gain_per_s squared/4: both poles at half of the gain"},
      {"wheel_gain_V_s_per_rad", "pole placement with a delay of two periods and a gain margin of 3 for a wheel in the air"},
      {"wheel_integral_V_per_rad", "damping ratio 1 with that gain"},
      {"tracking_time_s", "a fifth of wheel gain per integral, at least five periods"},
      {"speed_limit_m_per_s", of_robot(source.robot, "limits.speed")},
      {"yaw_rate_limit_rad_per_s", of_robot(source.robot, "limits.yaw_rate")},
      {"acceleration_limit_m_per_s2", of_robot(source.robot, "limits.acceleration")},
      {"yaw_acceleration_limit_rad_per_s2", of_robot(source.robot, "limits.yaw_acceleration")},
      {"jerk_limit_m_per_s3", of_robot(source.robot, "limits.jerk")},
      {"traction_ratio", of_robot(source.robot, "traction.coefficient") + ", less the drag of the rollers"},
      {"command_timeout_s", "default of the drive core"},
      {"braking_reserve_K", "heating of the winding by one full stop from speed_limit_m_per_s with robot file: limits.braking"},
      {"limp_current_A",
       "smallest current that the derating still allows in the steady state of each continuous use, over all speeds and hot "
       "cases"},
      {"warning_time_s", "default of the drive core"},
  };
}

Origins derived_origins() {
  return {{"per_lowest_resistance_A_per_V", "1/lowest_resistance_ohm"},
          {"per_resistance_A_per_V", "1/resistance_ohm"},
          {"volt_per_Nm", "resistance_ohm/(torque constant*gear ratio*gear efficiency)"},
          {"per_tracking_time_per_s", "1/tracking_time_s"},
          {"plane_xx_factor", "inverse of the sum of the wheels' directions times themselves"},
          {"plane_xy_factor", "inverse of the sum of the wheels' directions times themselves"},
          {"plane_yy_factor", "inverse of the sum of the wheels' directions times themselves"}};
}

/// A member as drive_core.h declares it.
struct Member {
  std::string type;
  std::string name;
  std::string meaning;
};

/// Returns the members of a struct in order, up to `unused`.
std::vector<Member> members_of(const std::string& header, const std::string& name) {
  static const std::regex kMember(R"(^  ([\w:]+) (\w+)(?:\[kMostWheels\])?(?: = [^;]*)?;(?:\s*///< (.*))?$)");
  std::vector<Member> members;
  std::istringstream lines(header.substr(std::min(header.find("struct " + name + " {"), header.size())));
  for (std::string line; std::getline(lines, line) && line != "};" && line.find(" unused[") == std::string::npos;) {
    if (std::smatch found; std::regex_match(line, found, kMember)) {
      members.push_back({found[1], found[2], found[3]});
    }
  }
  return members;
}

/// Writes the values of a Config in the order of their declaration, which is their order in memory: so none can be forgotten.
class Writer {
 public:
  Writer(const CoreSource& source, std::string header) : header_(std::move(header)), bytes_(reinterpret_cast<const char*>(&source.config)) {
    for (const Origins& origins : {body_origins(source), control_origins(source)}) {
      origins_.insert(origins.begin(), origins.end());
    }
    wheel_origins_ = wheel_origins(source.config.has_friction, origin_of_slip(source.robot));
  }

  std::string config() {
    std::string text = members("Config", origins_, "    ");
    if (offset_ != offsetof(robot_core::Config, unused)) {
      throw base::Failure(base::ExitCode::bug, "drive_core.h declares a Config that core_config.h cannot be written from");
    }
    return text;
  }

 private:
  std::string members(const std::string& name, const Origins& origins, const std::string& indent) {
    std::string text;
    for (const Member& member : members_of(header_, name)) {
      if (member.type == "WheelConfig") {
        text += fmt::format("{}.{} =\n{}    {{\n", indent, member.name, indent);
        for (int i = 0; i < robot_core::kMostWheels; ++i) {
          // One wheel with comments is enough.
          text += fmt::format("{0}        {{\n{1}{0}        }},\n", indent,
                              members(member.type, i == 0 ? wheel_origins_ : kNone, indent + "            "));
        }
        text += indent + "    },\n";
      } else if (member.type == "DerivedConfig") {
        text += fmt::format("{0}.{1} =\n{0}    {{\n{2}{0}    }},\n", indent, member.name,
                            members(member.type, derived_origins(), indent + "        "));
      } else {
        text += fmt::format("{}.{} = {},{}\n", indent, member.name, value(member), comment(member, origins));
      }
    }
    return text;
  }

  static std::string comment(const Member& member, const Origins& origins) {
    if (&origins == &kNone) {
      return "";
    }
    const auto origin = origins.find(member.name);
    const std::string text = origin != origins.end() ? origin->second : member.meaning;
    // What is neither calculated here nor described follows from the rest.
    return "  // " + in_one_line(text.empty() ? "robot_core::complete()" : text);
  }

  template <class Number>
  Number next() {
    Number number{};
    std::memcpy(&number, bytes_ + offset_, sizeof number);
    offset_ += sizeof number;
    return number;
  }

  std::string value(const Member& member) {
    if (member.type == "float") {
      return float_literal(next<float>());
    }
    if (member.type == "bool") {
      return next<bool>() ? "true" : "false";
    }
    if (member.name == "check_sum") {
      return fmt::format("0x{:08X}U", next<std::uint32_t>());
    }
    return std::to_string(next<std::int32_t>());
  }

  inline static const Origins kNone;
  std::string header_;
  const char* bytes_;
  std::size_t offset_ = 0;
  Origins origins_;
  Origins wheel_origins_;
};

std::string declaration() {
  for (const embedded::Text& each : embedded::core_sources()) {
    if (each.path == "robot_core/drive_core.h") {
      return std::string(each.text);
    }
  }
  throw base::Failure(base::ExitCode::bug, "the program has no drive_core.h to write");
}

}  // namespace

std::string core_config_header(const CoreSource& source) {
  std::string text = fmt::format(
      "// Configuration of the drive core for {} with {}.\n"
      "// Generated by `heatsoak generate core`, {}: change the files of robot and motor and generate it again.\n"
      "//\n"
      "// options  {}\n"
      "// inputs   {} {} of both files and the options\n"
      "//\n"
      "// Meaning of each value: robot_core/drive_core.h. Equations: src/firmware/core_config.h and wheel_loop.h of heatsoak.\n"
      "#pragma once\n\n#include \"motor_guard.h\"\n#include \"robot_core/drive_core.h\"\n\n"
      "/// Without the planner of pose targets.\n"
      "inline constexpr robot_core::Config kCoreConfig{{\n",
      in_one_line(source.robot.id), in_one_line(source.motor.id), source.version, in_one_line(source.options_text), derate::kInputHash,
      source.hash);
  text += Writer(source, declaration()).config() + "    .guard = &kMotorGuard,\n};\n\n";
  return text +
         "namespace core_config_detail {\n\nconstexpr robot_core::Config with_planner(robot_core::Config config) {\n"
         "  // The check sum leaves pointers out.\n  config.plan_step = &robot_core::plan_to_pose;\n"
         "  config.predict_pose = &robot_core::predict_pose;\n  return config;\n}\n\n"
         "}  // namespace core_config_detail\n\n"
         "/// With the planner of pose targets. The linker leaves the planner out if nothing refers to this.\n"
         "inline constexpr robot_core::Config kCoreConfigWithPlanner = core_config_detail::with_planner(kCoreConfig);\n";
}

}  // namespace heatsoak::firmware
