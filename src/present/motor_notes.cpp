#include "present/motor_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <vector>

#include "base/quantity.h"
#include "motor/conditions.h"
#include "motor/default_spread.h"
#include "motor/lint.h"
#include "motor/measured_power.h"
#include "present/evaluation.h"

namespace heatsoak::present {

std::string columns_at_their_hottest(std::span<const motor::Motor> motors) {
  std::string text;
  for (const motor::Motor& motor : motors) {
    for (const motor::MotorEffect& effect : motor.effects) {
      if (!effect.column.empty()) {
        text +=
            fmt::format("{}: {} depends on {}, which is unknown here: its hottest value is used\n", motor.id, effect.name, effect.column);
      }
    }
  }
  return text;
}

std::string effects_under_conditions(std::span<const motor::Motor> motors) {
  std::string text;
  for (const motor::Motor& motor : motors) {
    for (const auto& [key, value] : motor.assumed) {
      text += fmt::format("{}: this result is valid only if {} is {}, as stated with --condition\n", motor.id, key, value);
    }
    for (const motor::MotorEffect& effect : motor.effects) {
      if (effect.condition.empty()) {
        continue;
      }
      std::vector<std::string> where;
      std::ranges::transform(effect.condition, std::back_inserter(where),
                             [](const auto& part) { return fmt::format("{}={}", part.first, part.second); });
      text += fmt::format("{}: {}, found under {}, {}\n", motor.id, effect.name, fmt::join(where, " "),
                          motor::acts_by_default(effect, effect.values()) ? "acts always unless --condition states otherwise"
                                                                          : "cools, and acts only if --condition states it");
    }
  }
  return text;
}

std::string inactive_effects(std::span<const motor::Motor> motors, Neighbours neighbours) {
  std::string text = columns_at_their_hottest(motors) + effects_under_conditions(motors);
  for (const motor::Motor& motor : motors) {
    for (const motor::MotorEffect& effect : motor.effects) {
      for (const thermal::Signal signal : effect.type->needed_with(effect.values())) {
        const auto& [consequence, quantity] = base::row_of(signal).unstated;
        const bool is_neighbour = signal == thermal::Signal::neighbour_temperature;
        if (!quantity.empty() && !(is_neighbour && neighbours == Neighbours::known)) {
          text += fmt::format(
              "{}: {} {}{}, because a duty does not state {}\n", motor.id, effect.name, consequence,
              is_neighbour && neighbours == Neighbours::known_in_closed_loop ? " of the table and the picture without a closed loop" : "",
              quantity);
        }
      }
    }
  }
  return text;
}

void add_motor_notes(Document& document, std::span<const motor::Motor> motors, Neighbours neighbours) {
  add_lines(document.notes, value_warnings(motors), Severity::warning);
  add_lines(document.notes, inactive_effects(motors, neighbours), Severity::note);
}

std::string value_warnings(std::span<const motor::Motor> motors) {
  std::string text;
  for (const motor::Motor& motor : motors) {
    for (const motor::LintFinding& each : motor::doubtful_values(motor)) {
      text += fmt::format("{}: {}\n", motor.id, motor::words_of(each));
    }
    if (const std::optional<motor::HeatInput> heat = motor::measured_power(motor)) {
      text += fmt::format(
          "{}: the thermal values were fitted to heat from measured power ({}). Here no power is measured: the heat is I²·R and the losses "
          "of the motor file. A loss that only the power showed, such as that of the driver or of hot magnets, is left out, and "
          "temperatures may be too low\n",
          motor.id, motor::name_of(*heat));
    }
    if (const std::vector<std::string> only = motor::unstated_fit_conditions(motor); !only.empty()) {
      text += fmt::format(
          "{}: temperatures may be too low, and currents too large, under other conditions than {}: all runs that the values were fitted "
          "to "
          "had it. If it always holds, state it (--condition {}); else fit the file to runs without it\n",
          motor.id, fmt::join(only, " "), fmt::join(only, " --condition "));
    }
    if (const std::vector<std::string> missing = motor::conditions_without_runs(motor); !missing.empty()) {
      text += fmt::format("{}: temperatures and currents are guesses under {}: no run that the values were fitted to had it\n", motor.id,
                          fmt::join(missing, " "));
    }
    if (motor.fit && motor.fit->unmodelled_heat_share) {
      text += fmt::format(
          "{}: the calibration found heat that the model lacks, {} % of the mean heat of its runs or more. Temperatures and allowed "
          "currents "
          "may be wrong by more than their intervals state; `heatsoak diagnose` searches for the missing effect\n",
          motor.id, base::significant(100.0 * *motor.fit->unmodelled_heat_share, 2));
    }
  }
  return text;
}

std::string default_spreads_text(std::span<const motor::Motor> motors) {
  std::string text;
  for (const motor::Motor& motor : motors) {
    std::vector<motor::DefaultSpread> stated = motor::default_spreads(motor);
    const auto is_fitted = [&](const motor::DefaultSpread& each) {
      return each.origin == base::Origin::measured && motor.fit &&
             std::ranges::find(motor.fit->parameters, each.key) != motor.fit->parameters.end();
    };
    const auto first_fitted = std::ranges::stable_partition(stated, std::not_fn(is_fitted)).begin();
    const std::vector<motor::DefaultSpread> fitted(first_fitted, stated.end());
    stated.erase(first_fitted, stated.end());
    if (!stated.empty()) {
      text += fmt::format(
          "{}: the file gives no tolerance for these values, or one that is narrower than their origin supports; defaults by origin are "
          "assumed: {}; state the real ones\n",
          motor.id, motor::to_string(stated));
    }
    if (!fitted.empty()) {
      text += fmt::format(
          "{}: the calibration gives narrower intervals for these values than sensors support; wider ones are assumed: {}; the file needs "
          "no change\n",
          motor.id, motor::to_string(fitted));
    }
  }
  return text;
}

}  // namespace heatsoak::present
