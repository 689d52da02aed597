// A motor with its observer and table, made as `derate` makes them but with a safety factor chosen by the test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"
#include "motor/datasheet_network.h"
#include "support/shipped.h"

namespace heatsoak::derate {

/// Returns the paper's motor with effects appended to its data sheet, as a diagnosis writes them.
inline motor::Motor ecx_32_with(const std::string& lines) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_guarded_{}.toml", static_cast<int>(getpid()));
  std::ifstream sheet(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  std::ofstream(file) << sheet.rdbuf() << "\n" << lines;
  motor::Motor motor = motor::read_motor(file);
  std::filesystem::remove(file);
  return motor;
}

/// Line of a motor's file with an estimated value, such as `estimated("loss", "0.5 W")`.
inline std::string estimated(std::string_view key, std::string_view text) {
  return fmt::format("{} = {{ value = \"{}\", origin = \"estimated\", derivation = \"a test\" }}\n", key, text);
}
/// Table of an effect in a motor's file; `values` are its lines.
inline std::string effect_table(std::string_view type, const std::string& values) {
  return fmt::format("[effects.of_{0}]\ntype = \"{0}\"\n{1}\n", type, values);
}

/// Returns a heating curve over the temperature or speed in `lines`, with its maximum at the middle knot.
inline std::string hump(const std::string& lines, double most_W) {
  std::string law = "[effects.hump]\ntype = \"tabulated\"\nform = \"heat\"\n" + lines;
  for (int knot = 1; knot <= 7; ++knot) {
    law +=
        fmt::format("value_{} = {{ value = \"{} W\", origin = \"estimated\", derivation = \"a test\" }}\n", knot, knot == 4 ? most_W : 0.0);
  }
  return law;
}

inline BarrierRules rules_for(const motor::Motor& motor, double approach_s = 0.5) {
  DerateOptions options;
  options.approach_s = approach_s;
  return barrier_rules(motor, twente(), options);
}

struct GuardedMotor {
  GuardedMotor(const motor::Motor& of, const BarrierRules& with, double heat_safety_factor)
      : motor(of),
        rules(with),
        network(motor::datasheet_network(motor, motor::nominal_sample(motor))),
        observer(network, motor.nominal, twente(), heat_safety_factor),
        table(current_table(observer, rules)) {}

  motor::Motor motor;
  BarrierRules rules;
  thermal::Network network;
  Observer observer;
  CurrentTable table;
};

/// Random load: mostly the full allowed current, sometimes a share of it, at a random speed, held for a while.
class RandomLoad {
 public:
  explicit RandomLoad(unsigned seed) : engine_(seed) {}

  struct Wish {
    double current_share = 1.0;
    double speed_share = 0.0;
  };
  Wish after(double period_s) {
    left_s_ -= period_s;
    if (left_s_ <= 0.0) {
      left_s_ = std::exponential_distribution<double>(0.2)(engine_);
      const double draw = uniform();
      wish_ = {draw < 0.6 ? 1.0 : draw < 0.8 ? 0.0 : uniform(), uniform() < 0.3 ? 0.0 : uniform()};
      wish_.current_share *= uniform() < 0.3 ? -1.0 : 1.0;
    }
    return wish_;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>()(engine_); }

  std::mt19937_64 engine_;
  double left_s_ = 0.0;
  Wish wish_;
};

/// Returns a derating with the observer and the table of `guarded`; motor and robot have the ids "guarded" and "roboteam_twente_v2024".
inline Derating derating_of(const GuardedMotor& guarded) {
  return {.motor_id = "guarded",
          .robot_id = "roboteam_twente_v2024",
          .data_quality = "estimated",
          .torque_constant_Nm_per_A = guarded.motor.nominal.torque_constant_Nm_per_A,
          .observer = guarded.observer,
          .rules = guarded.rules,
          .table = guarded.table,
          .options = {},
          .assumed = {},
          .effects = {},
          .guarantee = {.samples = 400, .over = 10},
          .uses = {},
          .reachable_speed_rad_per_s = guarded.rules.most_speed_rad_per_s};
}

/// Laws with a power and with exponentials.
inline constexpr const char* kPowerAndExponential = R"([effects.air]
type = "natural_convection"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.25", origin = "estimated", derivation = "a test" }

[effects.knee]
type = "saturation"
excess = { value = "0.3", origin = "estimated", derivation = "a test" }
knee_current = { value = "5 A", origin = "estimated", derivation = "a test" }
knee_width = { value = "0.1", origin = "estimated", derivation = "a test" }
)";

/// The ECX FLAT 32 L with a third body, such as a chassis, at the stator. Values with units as in a motor file.
inline motor::Motor ecx_32_with_chassis(const char* heat_capacity, const char* conductance, const char* leak_ratio) {
  return ecx_32_with("[effects.chassis]\ntype = \"third_node\"\n" + estimated("heat_capacity", heat_capacity) +
                     estimated("conductance", conductance) + estimated("leak_ratio", leak_ratio));
}

}  // namespace heatsoak::derate
