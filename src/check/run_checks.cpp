#include "check/run_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "base/parallel.h"
#include "check/computations.h"
#include "check/limit.h"
#include "robot/robot_lint.h"

namespace heatsoak::check {
namespace {

/// Joins the summary and the diagnostics of a failure in one line.
std::string reason_of(const base::Failure& failure) {
  std::string text = failure.message();
  for (const base::Diagnostic& each : failure.diagnostics()) {
    const std::string place = each.at.line > 0 ? fmt::format("{}:{}:{}", each.at.file, each.at.line, each.at.column) : each.at.file;
    text += fmt::format("{}{}{}{}{}{}", text.empty() ? "" : "; ", place, place.empty() ? "" : ": ", each.key, each.key.empty() ? "" : ": ",
                        each.message);
  }
  return text;
}

/// Throws Failure if a file that the threshold depends on does not exist.
void require_readable(const Check& check, const ThresholdType& type) {
  for (const auto& [setting, reason] : check.unreadable) {
    if (std::ranges::find(type.needs, setting) != type.needs.end() || std::ranges::find(type.takes, setting) != type.takes.end()) {
      throw base::Failure(base::ExitCode::bad_input, reason);
    }
  }
}

/// Returns whether a limit of the check needs the drawn samples of its duty.
bool needs_samples(const Check& check) {
  return check.robot && check.duty && std::ranges::any_of(check.limits, [](const Limit& limit) {
           const std::vector<Setting>& takes = limit.type->takes;
           return std::ranges::find(takes, Setting::samples) != takes.end();
         });
}

void evaluate_one(Outcome& outcome, Computations& computations) {
  try {
    require_readable(*outcome.check, *outcome.limit.type);
    if (outcome.check->robot && std::ranges::find(outcome.limit.type->needs, Setting::robot) != outcome.limit.type->needs.end()) {
      robot::require_sound(*outcome.check->robot);
    }
    Measured measured = outcome.limit.type->measure(*outcome.check, computations);
    if (std::isfinite(measured.value)) {
      outcome.measured = std::move(measured);
    } else {
      outcome.reason = "the result is not a number";
    }
  } catch (const base::Failure& failure) {
    outcome.reason = reason_of(failure);
  } catch (const std::bad_alloc&) {
    outcome.reason = "out of memory";
  }
  judge(outcome);
}

}  // namespace

std::optional<double> Outcome::margin_value() const {
  if (!measured) {
    return std::nullopt;
  }
  return limit.type->direction == Bound::at_most ? limit.value - measured->value : measured->value - limit.value;
}

void judge(Outcome& outcome) {
  if (!outcome.measured) {
    outcome.passed = false;
    return;
  }
  const ThresholdType& type = *outcome.limit.type;
  outcome.passed = keeps(type.direction, outcome.measured->value, outcome.limit.value);
  outcome.reason = outcome.passed ? std::string()
                                  : fmt::format("{} is {} the limit of {}", shown(outcome.measured->value, type),
                                                type.direction == Bound::at_most ? "above" : "below", shown(outcome.limit.value, type));
}

std::vector<Outcome> run_checks(const CheckFile& file, int threads, const base::Progress& progress) {
  std::vector<Outcome> outcomes;
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (const Check& check : file.checks) {
    const std::size_t first = outcomes.size();
    for (const Limit& limit : check.limits) {
      outcomes.push_back({.check = &check, .limit = limit, .reason = {}});
    }
    ranges.emplace_back(first, outcomes.size());
  }
  Computations computations(threads);
  for (const Check& check : file.checks) {
    if (needs_samples(check)) {
      computations.play_games(check);
    }
  }
  // Thresholds of one check mostly need the same results, so each check is one job.
  base::in_parallel(ranges.size(), threads, 0, ranges.size(), progress, [&](std::size_t job) {
    for (std::size_t i = ranges[job].first; i < ranges[job].second; ++i) {
      evaluate_one(outcomes[i], computations);
    }
  });
  return outcomes;
}

}  // namespace heatsoak::check
