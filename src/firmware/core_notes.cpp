#include "firmware/core_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/quantity.h"
#include "robot/assumed_friction.h"

namespace heatsoak::firmware {
namespace {

/// Returns the names of the motor's effects that need a signal.
std::vector<std::string> effects_with(const motor::Motor& motor, thermal::Signal signal) {
  std::vector<std::string> names;
  for (const motor::MotorEffect& effect : motor.effects) {
    const std::vector<thermal::Signal> needed = effect.type->needed_with(effect.values());
    if (std::ranges::find(needed, signal) != needed.end()) {
      names.push_back(effect.name);
    }
  }
  return names;
}

std::string names_of(const std::vector<std::string>& effects) {
  return effects.empty() ? "the motor's thermal law" : fmt::format("{}", fmt::join(effects, ", "));
}

std::string say(const FrictionUnknown& of) {
  return fmt::format(
      "feed-forward of friction is off, so the wheels lag until their integrators have compensated it: {} has no [friction]; measure it "
      "with `heatsoak friction`",
      of.robot_file);
}

std::string say(const InputNotMeasured& of) {
  return fmt::format("{} depends on {}", names_of(of.effects), derate::observed::firmware_of(of.input).unmeasured);
}

std::string say(const ColumnUnknown& of) {
  return fmt::format("{} depends on {} of the logs, which the core does not know: it uses the value with the most heating", of.effect,
                     of.column);
}

std::string say(const SpreadsAssumed& of) {
  return fmt::format("the motor's file gives no tolerance for these values, defaults by origin are assumed: {}",
                     motor::to_string(of.spreads));
}

std::string say(const ConditionStated& of) {
  return fmt::format("the guard is valid only if {} is {}, as stated with --condition", of.key, of.value);
}

std::string say(const ValueDoubtful& of) {
  return fmt::format("the guard may allow too much current, because a value of the motor's file is doubtful: {}",
                     motor::words_of(of.finding));
}

std::string say(const FittedToPower& of) {
  return fmt::format(
      "the guard may allow too much current, because the thermal values were fitted to heat from measured power ({}), which the core does "
      "not measure: a loss that only the power showed is left out",
      motor::name_of(of.heat));
}

std::string say(const FittedUnder& note) {
  return fmt::format(
      "the guard may allow too much current without {}, because all runs that the motor's values were fitted to had it; if it always "
      "holds, "
      "state it (--condition {})",
      fmt::join(note.conditions, " "), fmt::join(note.conditions, " --condition "));
}

std::string say(const HeatUnmodelled& of) {
  return fmt::format(
      "the guard may allow too much current, because the calibration found heat that the model lacks, {} % of the mean heat of its runs or "
      "more; `heatsoak diagnose` searches for the missing effect",
      base::significant(100.0 * of.share, 2));
}

std::string say(const ShadowModeChosen& /*of*/) {
  return "the guard limits no current, so a motor can overheat: --shadow only counts what it would have limited; generate the core again "
         "without --shadow before a match";
}

std::string say(const StopTakesCurrent& of) {
  return fmt::format(
      "the robot drives with less current than the motor could carry, because one full stop heats the winding by {:.0f} K of the {:.0f} K "
      "between air of {:.0f} °C and its limit; a lower limits.speed or limits.braking in the robot file helps",
      of.stop_K, of.room_K, of.hottest_ambient_C);
}

}  // namespace

std::vector<CoreNote> notes_on(const robot::Robot& robot, const motor::Motor& motor, const derate::Derating& derating,
                               double braking_reserve_K) {
  std::vector<CoreNote> notes;
  if (!robot::has_friction(robot)) {
    notes.emplace_back(FrictionUnknown{robot.file.filename().string()});
  }
  for (std::size_t i = 0; i < derate::observed::kSignalCount; ++i) {
    const auto input = static_cast<derate::observed::Signal>(i);
    if (derating.observer.uses(input) && !derate::observed::firmware_of(i).unmeasured.empty()) {
      notes.emplace_back(InputNotMeasured{input, effects_with(motor, derate::observed::row_of(i).signal.value())});
    }
  }
  for (const motor::MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      notes.emplace_back(ColumnUnknown{effect.name, effect.column});
    }
  }
  if (!derating.default_spreads.empty()) {
    notes.emplace_back(SpreadsAssumed{derating.default_spreads});
  }
  for (const auto& [key, value] : motor.assumed) {
    notes.emplace_back(ConditionStated{key, value});
  }
  for (const motor::LintFinding& each : derating.doubtful_values) {
    notes.emplace_back(ValueDoubtful{each});
  }
  if (derating.measured_power) {
    notes.emplace_back(FittedToPower{*derating.measured_power});
  }
  if (!derating.fit_conditions.empty()) {
    notes.emplace_back(FittedUnder{derating.fit_conditions});
  }
  if (derating.unmodelled_heat_share) {
    notes.emplace_back(HeatUnmodelled{*derating.unmodelled_heat_share});
  }
  constexpr double kLarge_share = 0.25;
  const double room_K = derating.rules.limits.winding_C - derating.rules.hottest_ambient_C;
  if (braking_reserve_K > kLarge_share * room_K) {
    notes.emplace_back(StopTakesCurrent{braking_reserve_K, room_K, derating.rules.hottest_ambient_C});
  }
  return notes;
}

bool is_unsafe(const CoreNote& note) {
  return std::holds_alternative<ValueDoubtful>(note) || std::holds_alternative<FittedToPower>(note) ||
         std::holds_alternative<HeatUnmodelled>(note) || std::holds_alternative<FittedUnder>(note) ||
         std::holds_alternative<ShadowModeChosen>(note);
}

std::string to_string(const CoreNote& note) {
  return std::visit([](const auto& each) { return say(each); }, note);
}

}  // namespace heatsoak::firmware
