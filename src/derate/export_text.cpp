#include "derate/export_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "base/unit_names.h"
#include "motor/datasheet_network.h"

namespace heatsoak::derate {
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7F; }, ' ');
  return text;
}

/// Lists the effects for which `is_listed(effect)` holds, such as "chassis (third_node)".
template <class IsListed>
std::string listed(const Derating& derating, const IsListed& is_listed) {
  std::string text;
  for (const ActingEffect& effect : derating.effects) {
    if (is_listed(effect)) {
      text += fmt::format("{}{}", text.empty() ? "" : ", ",
                          effect.name == effect.type ? effect.name : fmt::format("{} ({})", effect.name, effect.type));
    }
  }
  return text;
}

/// Returns the types of the effects whose laws depend on a signal.
std::set<std::string> types_that_use(const Observer& observer, std::size_t signal) {
  const thermal::Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(observer.rate_steps());
  std::vector<char> depends(needed.size(), 0);
  std::set<std::string> types;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula.steps()[i];
    if (step.operation == thermal::Operation::constant) {
      continue;
    }
    const bool is_input = step.operation == thermal::Operation::input;
    const std::string_view law = formula.law_of(static_cast<int>(i));
    // The sum of all heat is no part of the law that adds to it: it depends on the signals of the laws before.
    const auto brings = [&](int operand) {
      const std::string_view from = formula.law_of(operand);
      return depends[static_cast<std::size_t>(operand)] != 0 && (from.empty() || from == law);
    };
    depends[i] = is_input ? static_cast<std::size_t>(step.left) == signal : brings(step.left) || (step.right && brings(*step.right));
    if (!is_input && needed[i] != 0 && depends[i] != 0) {
      types.emplace(law);
    }
  }
  return types;
}

}  // namespace

std::string identifier(std::string_view id) {
  std::string name;
  for (const char c : id) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0 ? "motor_" + name : name;
}

std::string UniqueNames::add(std::string_view name) {
  const std::string first = identifier(name);
  const std::optional<base::UnitOfName> unit = base::unit_of_name(first);
  const std::string quantity = unit ? std::string(unit->quantity) : first;
  std::string unique = first;
  for (int next = 2; !taken_.insert(unique).second; ++next) {
    unique = fmt::format("{}_{}{}", quantity, next, first.substr(quantity.size()));
  }
  return unique;
}

std::string promised_share_text(const Derating& derating) {
  return fmt::format("with {:.0f} % certainty at least {:.6g} % of the motors within their tolerances", 100.0 * kCertainty_share,
                     100.0 * derating.options.guarantee.required_share);
}

std::string drawn_motors_text(const Guarantee& checked) {
  return fmt::format("{} of the {} drawn motors, which determined the safety factor, exceeded a limit", checked.over, checked.samples);
}

std::string confidence_text(const Derating& derating, const Guarantee& checked) {
  return fmt::format("Confidence {:.6g}: {} keep every limit in the {} hottest load patterns; {}.",
                     derating.options.guarantee.required_share, promised_share_text(derating), derating.uses.size(),
                     drawn_motors_text(checked));
}

std::vector<std::string> value_warnings(const Derating& derating) {
  std::vector<std::string> lines;
  for (const motor::LintFinding& each : derating.doubtful_values) {
    lines.push_back(fmt::format("DOUBTFUL: {}.", in_one_line(motor::words_of(each))));
  }
  if (derating.measured_power) {
    lines.push_back(fmt::format(
        "DOUBTFUL: the thermal values were fitted to heat from measured power ({}), which the firmware does not measure. A loss "
        "that only the power showed is left out, so the guard may allow too much current.",
        motor::name_of(*derating.measured_power)));
  }
  if (!derating.fit_conditions.empty()) {
    lines.push_back(fmt::format("DOUBTFUL: the values were fitted to runs with {} only. Without it, the guard may allow too much current.",
                                fmt::join(derating.fit_conditions, " ")));
  }
  if (derating.unmodelled_heat_share) {
    lines.push_back(
        fmt::format("DOUBTFUL: the calibration found heat that the model lacks, {:.2g} % of the mean heat or more. The guarantee does "
                    "not cover it.",
                    100.0 * *derating.unmodelled_heat_share));
  }
  return lines;
}

std::string provenance_lines(const Derating& derating, std::string_view comment) {
  std::string text = fmt::format(
      "{0} {1} in {2}, written by {3}; change the motor's file, not this one.\n"
      "{0} Inputs {4} {5}.\n"
      "{0} Winding limit {6:.6g} degC{7}, air up to {8:.6g} degC, thermal data: {9}.\n"
      "{0} Safety factor on heat {10:.4g}. {11}\n"
      "{0} Computed, not measured.\n",
      comment, in_one_line(derating.motor_id), in_one_line(derating.robot_id), in_one_line(derating.provenance.program_version), kInputHash,
      derating.provenance.input_hash, derating.rules.limits.winding_C,
      derating.rules.limits.stator_C ? fmt::format(", stator limit {:.6g} degC", *derating.rules.limits.stator_C) : "",
      derating.options.hottest_ambient_C, derating.data_quality, derating.observer.heat_safety_factor(),
      confidence_text(derating, derating.guarantee));
  for (const std::string& each : value_warnings(derating)) {
    text += fmt::format("{} {}\n", comment, each);
  }
  for (const auto& [key, value] : derating.assumed) {
    text += fmt::format("{} Valid only if {} is {} (--condition).\n", comment, in_one_line(key), in_one_line(value));
  }
  for (const motor::DefaultSpread& each : derating.default_spreads) {
    text += fmt::format("{} No tolerance in the motor's file, default by origin: {}\n", comment,
                        in_one_line(motor::to_string(std::span<const motor::DefaultSpread>(&each, 1))));
  }
  return text;
}

std::string law_lines(const Derating& derating, std::string_view comment) {
  std::vector<std::string> lines{"Laws of the model:"};
  for (const ActingEffect& effect : derating.effects) {
    lines.push_back(fmt::format(
        "  {}{}: {}{}", effect.name, effect.name == effect.type ? "" : fmt::format(" ({})", effect.type), effect.equation,
        effect.column.empty() ? "" : fmt::format("; depends on {} of the logs, evaluated at its hottest value", effect.column)));
    std::vector<std::string> values;
    for (const EffectParameter& each : effect.parameters) {
      const std::string number = fmt::format("{:.6g}{}{}", each.value, each.unit.empty() ? "" : " ", each.unit);
      values.push_back(fmt::format("{} {}", each.key, each.choice.empty() ? number : each.choice));
    }
    lines.push_back(fmt::format("    {}", fmt::join(values, ", ")));
  }
  std::vector<std::string> capacities;
  const thermal::Formula& formula = derating.observer.formula();
  for (std::size_t node = 0; node < derating.observer.state_count(); ++node) {
    const thermal::Formula::Step& rate = formula.steps()[static_cast<std::size_t>(derating.observer.rate_steps()[node])];
    const double per_capacity = rate.right ? formula.steps()[static_cast<std::size_t>(*rate.right)].value : 0.0;
    if (per_capacity > 0.0) {
      capacities.push_back(fmt::format("{} {:.6g} J/K", derating.observer.state_names()[node], 1.0 / per_capacity));
    }
  }
  lines.push_back(fmt::format("  heat capacities, P = C · dT/dt: {}", fmt::join(capacities, ", ")));
  std::string text;
  for (std::string& line : lines) {
    // Names and columns come from the user's files.
    line = in_one_line(line);
    for (std::size_t at = line.find("*/"); at != std::string::npos; at = line.find("*/")) {
      line.replace(at, 2, "* /");
    }
    text += fmt::format("{} {}\n", comment, line);
  }
  return text;
}

std::string ramp_lines(const Derating& derating, RampSignal signal, const CurrentRamp& ramp, double phase_per_dc_ratio,
                       std::string_view comment) {
  const RampLoss loss = ramp_loss(derating, signal, ramp);
  const bool is_stator = signal == RampSignal::stator;
  return fmt::format(
      "{0} Ramp over the {1}: below the table for every speed up to {2:.0f} rad/s and every {3} temperature up to the limit.\n"
      "{0} Less current than the table: {4:.2f} A ({5:.1f} %) of {6:.2f} A on average from {7:.0f} to {8:.0f} degC, at most {9:.2f} A at "
      "{10:.0f} degC.\n"
      "{0} Short peaks: the table allows {11:.1f} A for a motor at {12:.0f} degC, the ramp never more than {13:.2f} A.\n"
      "{0} Not covered: a sensor that reads low, a motor that is pushed above {2:.0f} rad/s, d-axis current (field weakening).\n",
      comment, is_stator ? "measured stator temperature" : "observer's winding temperature", derating.rules.most_speed_rad_per_s,
      is_stator ? "winding" : "stator", phase_per_dc_ratio * loss.mean_A(), loss.mean_percent(), phase_per_dc_ratio * loss.bound_mean_A,
      loss.from_C, loss.to_C, phase_per_dc_ratio * loss.most_A, loss.most_at_C, phase_per_dc_ratio * loss.peak_A,
      derating.options.hottest_ambient_C, phase_per_dc_ratio * ramp.most_current_A);
}

unsigned guard_signature(const Derating& derating, std::string_view form) {
  const std::string all = fmt::format("{}|{}|{}|{}{}", derating.motor_id, derating.robot_id, derating.options.period_s,
                                      derating.observer.heat_safety_factor(), form);
  boost::crc_32_type sum;
  sum.process_bytes(all.data(), all.size());
  return sum.checksum();
}

std::string own_effects_text(const Derating& derating) {
  const std::string text = listed(derating, [](const ActingEffect& effect) {
    return std::ranges::find(motor::kDatasheetEffects, effect.name) == motor::kDatasheetEffects.end();
  });
  return text.empty() ? "no additional effects" : text;
}

std::string effects_text(const Derating& derating, const std::set<std::string>& types) {
  const std::string text = listed(derating, [&](const ActingEffect& effect) { return types.contains(effect.type); });
  return text.empty() ? own_effects_text(derating) : text;
}

void require_finite(const Derating& derating) {
  const CurrentTable& table = derating.table;
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const double numbers[] = {table.resistance_at_0C_ratio,
                            table.resistance_ratio_per_K,
                            derating.rules.limits.winding_C,
                            derating.rules.limits.stator_C.value_or(0.0),
                            derating.rules.most_current_A,
                            derating.rules.most_speed_rad_per_s,
                            derating.torque_constant_Nm_per_A,
                            derating.observer.heat_safety_factor(),
                            derating.options.hottest_ambient_C,
                            derating.options.coldest_ambient_C,
                            derating.options.guarantee.required_share,
                            derating.options.period_s};
  if (!std::ranges::all_of(numbers, is_finite) || !std::ranges::all_of(table.heat_per_ohm_A2, is_finite) ||
      !std::ranges::all_of(table.speed_rad_per_s, is_finite) || !std::ranges::all_of(table.stator_C, is_finite) ||
      !std::ranges::all_of(table.winding_C, is_finite)) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{}: a value of the derating is not a number; check the motor's and the robot's file with `heatsoak lint`",
                    derating.motor_id));
  }
}

void require_brushless(std::string_view controller, const Derating& derating) {
  if (!derating.is_brushless) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{} cannot drive {}: it is a brushed motor, expected a brushless one; use --to c_header", controller,
                                    derating.motor_id));
  }
}

void require_three_signals(std::string_view controller, const Derating& derating) {
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    const bool is_searched = observed::signals()[i].worst == thermal::WorstCase::searched;
    if (is_searched && derating.observer.uses(static_cast<observed::Signal>(i))) {
      throw base::Failure(
          base::ExitCode::bad_input,
          fmt::format("{} cannot express {}: the law depends on {}, which the controller does not know; use --to c_header", controller,
                      effects_text(derating, types_that_use(derating.observer, i)), observed::signals()[i].name));
    }
  }
}

double rounded_to_12_digits(double value) { return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr); }

double rounded_down_A(double current_A) { return std::floor(1000.0 * current_A) / 1000.0; }

std::string significant_above(double value, int digits) {
  const double unit = value > 0.0 ? std::pow(10.0, std::floor(std::log10(value)) + 1.0 - digits) : 1.0;
  return base::significant(std::ceil(value / unit) * unit, digits);
}

}  // namespace heatsoak::derate
