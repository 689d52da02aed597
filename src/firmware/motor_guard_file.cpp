// motor_guard.h and motor_guard.cpp: the thermal guard of one motor.
#include <fmt/format.h>

#include <algorithm>

#include "derate/export_text.h"
#include "derate/rate_lines.h"
#include "firmware/core_files.h"

namespace heatsoak::firmware {
namespace {

std::string_view name_of(derate::observed::Signal signal) { return derate::observed::signals()[static_cast<std::size_t>(signal)].name; }

/// Returns the literal of a value; in parentheses if negative.
std::string operand_literal(double value) {
  const std::string text = float_literal(static_cast<float>(value));
  return text.front() == '-' ? fmt::format("({})", text) : text;
}

const derate::LineStyle kGuardStyle{
    .literal = operand_literal,
    .signal = [](derate::observed::Signal signal) { return fmt::format("signal[robot_core::guard_{}]", name_of(signal)); },
    .square_root = "robot_core::square_root"};

std::string array(std::string_view name, const float* values, int count) {
  std::string text = fmt::format("constexpr float {}[{}] = {{", name, count);
  constexpr int kInLine = 10;
  for (int i = 0; i < count; ++i) {
    text += fmt::format("{}{},", i % kInLine == 0 ? "\n    " : " ", float_literal(values[i]));
  }
  return text + "\n};\n";
}

std::string arrays(const robot_core::GuardModel& guard) {
  const heatsoak_current_table& table = guard.table;
  const int heats = table.speed_rad_per_s.count * table.stator_C.count * table.winding_C.count;
  std::string text = array("kSpeed_rad_per_s", table.speed_rad_per_s.points, table.speed_rad_per_s.count) +
                     array("kStator_C", table.stator_C.points, table.stator_C.count) +
                     array("kWinding_C", table.winding_C.points, table.winding_C.count) +
                     "// Copper heat of the allowed current in A^2, I^2 * R / R25, by speed, then stator, then winding.\n" +
                     array("kHeatPerOhm_A2", table.heat_per_ohm_A2, heats) + "\n// Possible values of an unknown signal.\n";
  for (int i = 0; i < robot_core::kGuardSignals; ++i) {
    if (const robot_core::PlausibleRange& plausible_range = guard.plausible_range[i]; plausible_range.is_used) {
      text += array(fmt::format("kPossible_{}", name_of(static_cast<derate::observed::Signal>(i))), plausible_range.possible,
                    plausible_range.possible_count);
    }
  }
  return text + "\n";
}

std::string resting_temperatures(const robot_core::GuardModel& guard) {
  std::string text;
  for (int node = 0; node < guard.node_count; ++node) {
    text += fmt::format("{}{}", node == 0 ? "" : ", ", float_literal(guard.resting_C[node]));
  }
  return fmt::format("    .resting_C = {{{}}},\n", text);
}

std::string table(const robot_core::GuardModel& guard) {
  const heatsoak_current_table& table = guard.table;
  return fmt::format(
      "    .cold_current_A = {},\n    .heat_ratio = {},\n{}    .table = {{.speed_rad_per_s = {{kSpeed_rad_per_s, {}}},\n"
      "              .stator_C = {{kStator_C, {}}},\n              .winding_C = {{kWinding_C, {}}},\n"
      "              .heat_per_ohm_A2 = kHeatPerOhm_A2,\n              .resistance_at_0C_ratio = {},\n"
      "              .resistance_ratio_per_K = {},\n              .most_current_A = {},\n              .straight_below_A = {},\n"
      "              .most_speed_rad_per_s = {},\n              .no_current_speed_rad_per_s = {},\n"
      "              .winding_per_stator_K = {}}},\n",
      float_literal(guard.cold_current_A), float_literal(guard.heat_ratio), resting_temperatures(guard), table.speed_rad_per_s.count,
      table.stator_C.count, table.winding_C.count, float_literal(table.resistance_at_0C_ratio), float_literal(table.resistance_ratio_per_K),
      float_literal(table.most_current_A), float_literal(table.straight_below_A), float_literal(table.most_speed_rad_per_s),
      float_literal(table.no_current_speed_rad_per_s), float_literal(table.winding_per_stator_K));
}

std::string plausible_ranges(const robot_core::GuardModel& guard) {
  std::string text;
  for (int i = 0; i < robot_core::kGuardSignals; ++i) {
    const robot_core::PlausibleRange& plausible_range = guard.plausible_range[i];
    const std::string_view name = name_of(static_cast<derate::observed::Signal>(i));
    text += plausible_range.is_used ? fmt::format("            {{true, {}, {}, kPossible_{}, {}}},  // {}: accepted range\n",
                                                  float_literal(plausible_range.least), float_literal(plausible_range.most), name,
                                                  plausible_range.possible_count, name)
                                    : fmt::format("            {{}},  // {}: no law depends on it\n", name);
  }
  return text;
}

std::string effects(const derate::Derating& derating) {
  std::string text;
  for (const derate::ActingEffect& effect : derating.effects) {
    text += fmt::format("//   {}{}: {}{}\n", in_one_line(effect.name), effect.name == effect.type ? "" : fmt::format(" ({})", effect.type),
                        in_one_line(effect.equation),
                        effect.column.empty()
                            ? ""
                            : fmt::format("; depends on {} of the logs, evaluated at its hottest value", in_one_line(effect.column)));
  }
  return text;
}

std::string guarantee(const derate::Derating& derating) {
  const derate::Guarantee& checked = derating.guarantee;
  std::string text = fmt::format(
      "// Winding at most {:.0f} degC{}, air from {:.0f} to {:.0f} degC; thermal data: {}.\n"
      "// Safety factor on heat {:.3g}, which covers motors worse than their nominal values; the hottest winding reached {:.0f} degC.\n"
      "// {}\n"
      "// Computed, not measured.\n",
      derating.rules.limits.winding_C,
      derating.rules.limits.stator_C ? fmt::format(", stator at most {:.0f} degC", *derating.rules.limits.stator_C) : "",
      derating.options.coldest_ambient_C, derating.rules.hottest_ambient_C, derating.data_quality, derating.observer.heat_safety_factor(),
      checked.winding_most_C, derate::confidence_text(derating, checked));
  for (const std::string& each : derate::value_warnings(derating)) {
    text += fmt::format("// {}\n", each);
  }
  if (!derating.default_spreads.empty()) {
    text += fmt::format("// The motor's file gives no tolerance for these values; the drawn motors use defaults by origin:\n//   {}\n",
                        motor::to_string(derating.default_spreads));
  }
  for (const auto& [key, value] : derating.assumed) {
    text += fmt::format("// VALID ONLY IF {} is {}: stated with --condition.\n", in_one_line(key), in_one_line(value));
  }
  return text;
}

}  // namespace

std::string motor_guard_header(const CoreSource& source) {
  return fmt::format(
      "// Thermal guard of {} in {}: observer and derating table. Generated by `heatsoak generate core`, {}.\n"
      "//\n{}#pragma once\n\n#include \"robot_core/thermal_guard.h\"\n\nextern const robot_core::GuardModel kMotorGuard;\n",
      in_one_line(source.motor.id), in_one_line(source.robot.id), source.version, guarantee(source.derating));
}

std::string motor_guard_source(const CoreSource& source) {
  const robot_core::GuardModel& guard = source.guard;
  const derate::Observer& observer = source.derating.observer;
  const derate::RateLines lines(observer, observer.rate_steps(), kGuardStyle);
  std::string nodes;
  for (const std::string& name : source.derating.observer.state_names()) {
    nodes += fmt::format("{}{}", nodes.empty() ? "" : ", ", in_one_line(name));
  }
  const std::string includes = std::string(lines.calls_square_root() ? "#include \"robot_core/math.h\"\n" : "") +
                               (lines.calls_thermal_math() ? "#include \"robot_core/thermal_math.h\"\n" : "");
  return fmt::format(
             "// Thermal guard of {} in {}. Generated by `heatsoak generate core`, {}.\n//\n// Laws:\n{}"
             "#include \"motor_guard.h\"\n\n{}{}"
             "#ifdef __FAST_MATH__\n#error \"without -ffast-math: it removes the checks for values that are not a number\"\n#endif\n\n"
             "namespace {{\n\n",
             in_one_line(source.motor.id), in_one_line(source.robot.id), source.version, effects(source.derating), includes,
             includes.empty() ? "" : "\n") +
         arrays(guard) +
         fmt::format("/// dT/dt of {}.\nvoid rates(const void*, const float* signal, const float* state_C, float* rate_K_per_s) {{\n",
                     nodes) +
         lines.text() +
         fmt::format(
             "}}\n\n}}  // namespace\n\nextern constexpr robot_core::GuardModel kMotorGuard{{\n"
             "    .node_count = {},\n    .period_s = {},\n    .winding_limit_C = {},\n    .coldest_ambient_C = {},\n"
             "    .hottest_ambient_C = {},\n    .most_current_A = {},\n{}"
             "    .plausible_range =\n        {{\n{}        }},\n    .rates = &rates,\n}};\n",
             guard.node_count, float_literal(guard.period_s), float_literal(guard.winding_limit_C), float_literal(guard.coldest_ambient_C),
             float_literal(guard.hottest_ambient_C), float_literal(guard.most_current_A), table(guard), plausible_ranges(guard));
}

}  // namespace heatsoak::firmware
