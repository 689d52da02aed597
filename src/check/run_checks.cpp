#include "check/run_checks.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "check/command_answers.h"
#include "check/computations.h"
#include "check/number_limit.h"
#include "robot/robot_lint.h"
#include "select/round_plan.h"

namespace heatsoak::check {
namespace {

/// Throws Failure if a file that the threshold depends on does not exist.
void require_readable(const Check& check, const ThresholdType& type) {
  for (const auto& [setting, reason] : check.unreadable) {
    if (std::ranges::find(type.needs, setting) != type.needs.end() || std::ranges::find(type.takes, setting) != type.takes.end()) {
      throw base::Failure(base::ExitCode::bad_input, "", {reason});
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

/// Drives the match of a check if one of its limits needs that. A failure is kept for the limit.
void drive_ahead(const Check& check, Computations& computations) {
  const auto driven = std::ranges::find_if(check.limits, [](const Limit& limit) { return needs_drive(*limit.type); });
  if (driven == check.limits.end()) {
    return;
  }
  try {
    require_readable(check, *driven->type);
    robot::require_sound(*check.robot);
    static_cast<void>(computations.guarded_drive(check));
  } catch (const base::Failure&) {
    return;  // kept, or thrown again
  } catch (const NotEvaluated&) {
    return;  // kept, or thrown again
  }
}

Measured measure(const Check& check, Limit& limit, Computations& computations, const CommandAnswers& answers) {
  if (!check.command.empty()) {
    return measure_number(limit, answers.of(check));
  }
  require_readable(check, *limit.type);
  if (check.robot && std::ranges::find(limit.type->needs, Setting::robot) != limit.type->needs.end()) {
    robot::require_sound(*check.robot);
  }
  return limit.type->measure(check, computations);
}

void evaluate_one(Outcome& outcome, Computations& computations, const CommandAnswers& answers) {
  try {
    Measured measured = measure(*outcome.check, outcome.limit, computations, answers);
    if (std::isfinite(measured.value) || measured.is_never) {
      outcome.measured = std::move(measured);
    } else {
      outcome.reason = ResultNotFinite{};
    }
  } catch (const NotEvaluated& found) {
    outcome.reason = found.reason();
  } catch (const base::Failure& failure) {
    outcome.reason = Failed{failure, std::current_exception()};
  } catch (const std::bad_alloc&) {
    outcome.reason = OutOfMemory{};
  }
}

const std::string kPlaying = "playing games";
const std::string kDriving = "driving matches";
const std::string kChecking = "checking";

/// Expected work of a file's checks on two cores. Results that several checks share count once, for the first of them.
class ExpectedWork {
 public:
  std::map<const Check*, double> games_s;   ///< games of the first check that needs them
  double drive_s = 0.0;                     ///< on one core
  std::map<const Check*, double> others_s;  ///< the rest of each check

  explicit ExpectedWork(const CheckFile& file) {
    std::set<std::string> known;
    for (const Check& check : file.checks) {
      double& other_s = others_s[&check];
      for (const UsualWork& each : Computations::usual_work(check)) {
        if (known.insert(each.key).second) {
          (each.kind == UsualWork::Kind::games ? games_s[&check] : each.kind == UsualWork::Kind::drive ? drive_s : other_s) += each.usual_s;
        }
      }
    }
  }

  /// The games leave one core to a driven match. Returns the part of its duration that remains after them.
  [[nodiscard]] double drive_after_games_s() const { return std::max(0.0, drive_s - 2.0 * sum_s(games_s)); }

  /// Returns the phases of run_checks(). A drive beside the games delays them.
  [[nodiscard]] std::vector<base::JobPhase> phases() const {
    std::vector<base::JobPhase> all;
    const double all_games_s = sum_s(games_s);
    for (const auto& [check, work_s] : games_s) {
      all.push_back({kPlaying, work_s * (1.0 + std::min(1.0, 0.5 * drive_s / all_games_s))});
    }
    if (drive_after_games_s() > 0.0) {
      all.push_back({kDriving, drive_after_games_s()});
    }
    all.push_back({kChecking, sum_s(others_s)});
    return all;
  }

 private:
  static double sum_s(const std::map<const Check*, double>& works_s) {
    return std::accumulate(works_s.begin(), works_s.end(), 0.0, [](double sum, const auto& each) { return sum + each.second; });
  }
};

/// Finished work of the checks, which run at the same time. A check counts for its usual duration, whatever it reports.
class CheckedWork {
 public:
  explicit CheckedWork(const ExpectedWork& expected) {
    for (const auto& [check, work_s] : expected.others_s) {
      works_[check].all_s = work_s;
    }
  }

  /// Takes the progress of the phase.
  void begin(base::Progress progress) {
    const std::lock_guard lock(mutex_);
    progress_ = std::move(progress);
  }

  void add(const Check& check, double work_s) {
    const std::lock_guard lock(mutex_);
    if (!progress_) {
      return;  // work of an earlier phase
    }
    Work& work = works_.at(&check);
    work.done_s = std::min(work.all_s, work.done_s + work_s);
    report();
  }

  void finish(const Check& check) { add(check, works_.at(&check).all_s); }

 private:
  struct Work {
    double all_s = 0.0;
    double done_s = 0.0;
  };

  void report() const {
    Work sum;
    for (const auto& [check, work] : works_) {
      sum.all_s += work.all_s;
      sum.done_s += work.done_s;
    }
    const auto in_ms = [](double time_s) { return static_cast<std::size_t>(1e3 * time_s); };
    progress_(in_ms(sum.done_s), in_ms(sum.all_s));
  }

  std::mutex mutex_;
  std::map<const Check*, Work> works_;
  base::Progress progress_;
};

}  // namespace

std::optional<double> Outcome::margin_value() const {
  if (!measured) {
    return std::nullopt;
  }
  return limit.type->direction == Bound::at_most ? limit.value - measured->value : measured->value - limit.value;
}

Status Outcome::status() const {
  return !measured ? Status::not_evaluated : keeps(limit.type->direction, measured->value, limit.value) ? Status::kept : Status::broken;
}

OutcomeCounts count(std::span<const Outcome> outcomes) {
  OutcomeCounts counts;
  for (const Outcome& each : outcomes) {
    ++counts.all;
    counts.broken += each.status() == Status::broken ? 1 : 0;
    counts.not_evaluated += each.status() == Status::not_evaluated ? 1 : 0;
  }
  return counts;
}

std::vector<Outcome> run_checks(const CheckFile& file, int threads, const CommandAnswers& answers, const base::JobProgress& progress) {
  std::vector<Outcome> outcomes;
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (const Check& check : file.checks) {
    const std::size_t first = outcomes.size();
    for (const Limit& limit : check.limits) {
      outcomes.push_back({.check = &check, .limit = limit});
    }
    ranges.emplace_back(first, outcomes.size());
  }
  const ExpectedWork expected(file);
  CheckedWork work(expected);
  Computations computations(threads, [&work](const Check& check, double work_s) { work.add(check, work_s); });
  // A driven match cannot be divided among threads, so it begins at once, beside the games that many thresholds wait for.
  base::in_parallel(file.checks.size() + 1, threads, [&](std::size_t job) {
    if (job < file.checks.size()) {
      drive_ahead(file.checks[job], computations);
      return;
    }
    for (const Check& check : file.checks) {
      if (needs_samples(check)) {
        computations.play_games(check, expected.games_s.contains(&check) ? progress.begin(kPlaying) : base::Progress());
      }
    }
    if (expected.drive_after_games_s() > 0.0) {
      progress.begin(kDriving);
    }
  });
  work.begin(progress.begin(kChecking));
  // Thresholds of one check mostly need the same results, so each check is one job.
  base::in_parallel(ranges.size(), threads, [&](std::size_t job) {
    for (std::size_t i = ranges[job].first; i < ranges[job].second; ++i) {
      evaluate_one(outcomes[i], computations, answers);
    }
    work.finish(file.checks[job]);
  });
  return outcomes;
}

std::vector<base::JobPhase> check_phases(const CheckFile& file) { return ExpectedWork(file).phases(); }

}  // namespace heatsoak::check
