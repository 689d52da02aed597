#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <string_view>
#include <variant>

#include "base/counted.h"
#include "check/limit.h"
#include "check/limit_words.h"
#include "present/check_words.h"
#include "present/derating.h"
#include "present/failure_words.h"
#include "select/spread.h"

namespace heatsoak::present {
namespace {

/// Returns the failure with the words of its own type.
base::Failure worded(const check::Failed& of) {
  if (!of.own) {
    return of.failure;
  }
  try {
    std::rethrow_exception(of.own);
  } catch (const base::Failure& own) {
    return in_words(own);
  }
}

/// Joins the summary and the diagnostics of a failure in one line.
std::string say(const check::Failed& of, const check::Limit& /*limit*/) {
  const base::Failure failure = worded(of);
  std::string text = failure.message();
  for (const base::Diagnostic& each : failure.diagnostics()) {
    const std::string place = base::to_string(each.at);
    text += fmt::format("{}{}{}{}{}{}", text.empty() ? "" : "; ", place, place.empty() ? "" : ": ", each.key, each.key.empty() ? "" : ": ",
                        each.message);
  }
  return text;
}

std::string say(const check::ResultNotFinite& /*of*/, const check::Limit& /*limit*/) { return "the result is not a number"; }

std::string say(const check::OutOfMemory& /*of*/, const check::Limit& /*limit*/) { return "out of memory"; }

std::string say(const check::DemandNotDelivered& of, const check::Limit& /*limit*/) {
  return fmt::format(
      "{} cannot deliver what the duty demands ({}): it delivers {:.0f} % of the demanded current at the worst moment, and too little for "
      "{:.0f} % of the time",
      of.motor_id, select::to_string(of.limit), 100.0 * of.least_torque_share, 100.0 * of.short_time_share);
}

std::string say(const check::TooFewSamples& of, const check::Limit& /*limit*/) {
  return fmt::format(
      "a bound of the 95th percentile needs {} samples or more, or {} if the duty is drawn at random; the check has {}. Set samples = "
      "\"{}\", or leave it out",
      select::fewest_samples_for_bound(false), select::fewest_samples_for_bound(true), of.samples, check::Check().samples);
}

std::string say(const check::LimitNeverReached& /*of*/, const check::Limit& /*limit*/) {
  return "no factor on the load brings the motor to its limit, so there is no margin to compare";
}

std::string say(const check::DutyIsNoMatch& of, const check::Limit& /*limit*/) {
  return fmt::format("the drive core can drive only a match; {} is {}. Expected a duty of the shape match", of.duty_id, of.shape);
}

std::string say(const check::RotorInertiaMissing& of, const check::Limit& /*limit*/) {
  return fmt::format("{} has no rotor_inertia, which is needed for the acceleration of a wheel", of.motor_file.string());
}

std::string say(const check::MatchNotDriven& of, const check::Limit& /*limit*/) {
  return fmt::format("the match was not driven: {}", simulate::to_string(of.problem));
}

std::string say(const check::TableOfOtherMotor& of, const check::Limit& /*limit*/) {
  return fmt::format("{}: the table is of another motor, {}; expected one of {}", of.table.string(), of.its_motor_id, of.motor_id);
}

std::string say(const check::SensorOptionsDiffer& of, const check::Limit& /*limit*/) {
  return fmt::format("{}: {}; 'derate' takes them as keys without \"--\", \"_\" for \"-\"", of.table.string(), words_of(of.difference));
}

std::string say(const check::ObserverDiffers& of, const check::Limit& /*limit*/) {
  const std::string table = of.table.string();
  return fmt::format(
      "{0}:{1}: the observer differs from that of a fresh header in {2}, so the table has another meaning: \"{3}\", fresh \"{4}\"; "
      "`heatsoak derate --check {0}` lists them; generate the header again{5}",
      table, of.first.line, base::counted(of.count, "place"), of.first.text, of.first.other_text,
      of.other_version.empty() ? "" : "; " + upgrade_words(of.other_version));
}

std::string say(const check::NothingToLint& /*of*/, const check::Limit& /*limit*/) {
  return "the check names nothing to lint; expected files, motor, robot or duty";
}

std::string say(const check::NoLogs& /*of*/, const check::Limit& /*limit*/) { return "the list of logs is empty"; }

std::string say(const check::NoMeasuredTemperature& /*of*/, const check::Limit& /*limit*/) {
  return "the logs have no temperature to compare with";
}

/// Returns at most twelve of the names, separated by commas.
std::string some_of(std::vector<std::string> names) {
  constexpr std::size_t kMost = 12;
  const bool is_cut = names.size() > kMost;
  names.resize(std::min(names.size(), kMost));
  return fmt::format("{}{}", fmt::join(names, ", "), is_cut ? ", …" : "");
}

std::string say(const check::NumberMissing& of, const check::Limit& /*limit*/) {
  const std::string group = of.group.empty() ? "the answer" : fmt::format("'{}'", of.group);
  if (of.members.empty()) {
    return fmt::format("there is no '{}' in {}, which has no members; `--json -` behind the command shows the numbers that it has",
                       of.missing, group);
  }
  const std::string advice = base::did_you_mean(std::string_view(of.missing).substr(0, of.missing.find('.')), of.members);
  return fmt::format("there is no '{}' in {}{}", of.missing, group,
                     advice.empty() ? fmt::format("; expected one of {}", some_of(of.members)) : advice);
}

std::string say(const check::NumberIsGroup& of, const check::Limit& /*limit*/) {
  return of.members.empty() ? fmt::format("'{}' is empty", of.name)
                            : fmt::format("'{}' is no number; expected one of its members: {}", of.name, some_of(of.members));
}

std::string say(const check::NumberIsNull& of, const check::Limit& /*limit*/) {
  return fmt::format("'{}' is null: the answer has no value there; expected a number that it has", of.name);
}

std::string say(const check::NumberIsOther& of, const check::Limit& /*limit*/) {
  return fmt::format("'{}' is {}; expected a number", of.name, of.value);
}

std::string say(const check::NumberIsThreshold& of, const check::Limit& /*limit*/) {
  return fmt::format(
      "'{0}' is a threshold, not a number of a command's answer; expected a check with robot, duty or motor in place of the command "
      "(`heatsoak describe {0}`)",
      of.name);
}

std::string say(const check::UnitsDiffer& of, const check::Limit& /*limit*/) {
  return fmt::format("'{}' and '{}' have different units; expected a limit for each", of.name, of.other_name);
}

std::string say(const check::NumberIsCount& of, const check::Limit& limit) {
  return fmt::format(
      "\"{0}\" is a percentage, but '{1}' is a whole number, {2:.0f}; expected {3} and a number without unit, such as \"{3} {2:.0f}\"",
      limit.text, of.name, of.value, check::to_string(limit.type->direction));
}

std::string say(const check::IntervalUnbounded& of, const check::Limit& limit) {
  return fmt::format(
      "the {:.3g} % interval of '{}' has no {} end, because the answer has too few samples; expected more of them (--samples of the "
      "command)",
      100.0 * (1.0 - select::kError_share), of.name, limit.type->direction == check::Bound::at_most ? "upper" : "lower");
}

std::string say(const check::LimitInvalid& of, const check::Limit& limit) { return check::words_of(of.problem, *limit.type); }

}  // namespace

base::Location place_of(const check::Outcome& outcome) {
  const auto* const failed = outcome.reason ? std::get_if<check::Failed>(&*outcome.reason) : nullptr;
  if (failed == nullptr) {
    return outcome.limit.at;
  }
  const base::Failure failure = worded(*failed);
  const bool begins_with_place = failure.message().empty() && !failure.diagnostics().empty() && failure.diagnostics().front().at.line;
  return begins_with_place ? failure.diagnostics().front().at : outcome.limit.at;
}

namespace {

std::string place_words(const check::Outcome& outcome) { return fmt::format("{}: ", base::to_string(place_of(outcome))); }

}  // namespace

std::string unlocated_explanation(const check::Outcome& outcome) {
  const std::string place = place_words(outcome);
  const std::string words = explanation_words(outcome);
  return words.starts_with(place) ? words.substr(place.size()) : words;
}

std::string located_explanation(const check::Outcome& outcome) { return place_words(outcome) + unlocated_explanation(outcome); }

std::string words_of(const check::Reason& reason, const check::Limit& limit) {
  return std::visit([&limit](const auto& each) { return say(each, limit); }, reason);
}

}  // namespace heatsoak::present
