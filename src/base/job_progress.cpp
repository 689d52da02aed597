#include "base/job_progress.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>

namespace heatsoak::base {
namespace {

/// Returns the standard deviation, relative to the median, of a log-normal value whose logarithm has this one.
double relative_sd(double log_sd) { return std::sqrt(std::expm1(log_sd * log_sd)); }

/// Sum of durations that are uncertain. A source of uncertainty is the speed of a name, of a kind or of the job, or one phase alone.
class UncertainSum {
 public:
  void add(double duration_s) { median_s_ += duration_s; }
  /// Durations that share a source deviate together, so their deviations add.
  void deviate_with(const std::string& source, double sd_s) { shared_sd_s_[source] += sd_s; }
  void deviate_alone(double sd_s) { own_variance_s2_ += sd_s * sd_s; }

  [[nodiscard]] double median_s() const { return std::max(kShortest_s, median_s_); }
  /// Returns the standard deviation of the logarithm of a log-normal sum with the variance of the parts.
  [[nodiscard]] double log_sd() const {
    constexpr double kLeast_sd = 0.02;
    double variance_s2 = own_variance_s2_;
    for (const auto& [source, sd_s] : shared_sd_s_) {
      variance_s2 += sd_s * sd_s;
    }
    return std::max(kLeast_sd, std::sqrt(std::log1p(variance_s2 / (median_s() * median_s()))));
  }

 private:
  static constexpr double kShortest_s = 1e-3;
  double median_s_ = 0.0;
  double own_variance_s2_ = 0.0;
  std::map<std::string, double> shared_sd_s_;
};

/// A possible remaining time.
struct Outcome {
  double median_s = 0.0;
  double log_sd = 0.0;
  double probability = 0.0;
};

/// Returns the probability that at most `time_s` remain.
double probability_until(const std::vector<Outcome>& outcomes, double time_s) {
  return std::accumulate(outcomes.begin(), outcomes.end(), 0.0, [time_s](double sum, const Outcome& each) {
    return sum + each.probability * 0.5 * std::erfc(-std::log(time_s / each.median_s) / (std::numbers::sqrt2 * each.log_sd));
  });
}

/// Returns the remaining time that the true one does not exceed with the given probability, by bisection of its logarithm.
double quantile_s(const std::vector<Outcome>& outcomes, double probability) {
  constexpr double kFar_sd = 4.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Outcome& each : outcomes) {
    low = std::min(low, std::log(each.median_s) - kFar_sd * each.log_sd);
    high = std::max(high, std::log(each.median_s) + kFar_sd * each.log_sd);
  }
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::midpoint(low, high);
    (probability_until(outcomes, std::exp(middle)) < probability ? low : high) = middle;
  }
  return std::exp(high);
}

}  // namespace

struct JobProgress::State {
  /// Measured work of phases of one name.
  struct Measured {
    std::string kind;
    double elapsed_s = 0.0;
    double work_s = 0.0;       ///< its expected duration
    double variance_s2 = 0.0;  ///< variance of that by the spreads of the ended phases
    double count = 0.0;        ///< number of ended phases
  };

  /// Returns the measured duration relative to the expected one; `otherwise` counts as if it had been measured for `assumed_s`.
  [[nodiscard]] static double ratio(const Measured& measured, double otherwise, double assumed_s) {
    const double work_s = measured.work_s + assumed_s;
    return work_s > 0.0 ? (measured.elapsed_s + otherwise * assumed_s) / work_s : otherwise;
  }

  Now now;
  double begin_s = 0.0;
  mutable std::mutex mutex;
  std::map<std::string, Measured> ended;  ///< by name of the phase
  std::vector<JobPhase> later;
  bool is_open = false;
  std::optional<JobPhase> present;
  double present_begin_s = 0.0;
  double report_s = 0.0;  ///< time of the last report, or of the begin of the phase
  double share = 0.0;     ///< finished share of the present phase at the last report

  /// Returns the measured work by name, with the part of the present phase that was reported.
  [[nodiscard]] std::map<std::string, Measured> measured() const {
    std::map<std::string, Measured> all = ended;
    Measured& own = all[present->what];
    own.kind = present->kind;
    own.elapsed_s += report_s - present_begin_s;
    own.work_s += share * present->work_s;
    return all;
  }

  /// Durations of phases at the measured speeds.
  class Speeds {
   public:
    Speeds(std::map<std::string, Measured> names, double later_s) : names_(std::move(names)), later_s_(later_s) {
      for (const auto& [what, measured] : names_) {
        for (Measured* const sum : {&job_, &kinds_[measured.kind]}) {
          sum->elapsed_s += measured.elapsed_s;
          sum->work_s += measured.work_s;
          sum->variance_s2 += measured.variance_s2;
        }
      }
    }

    /// Adds the duration of a share of a phase. Returns that duration.
    double add(const JobPhase& phase, double share, UncertainSum& sum) const {
      const Level job = level(&job_, kAssumed_share * (job_.work_s + later_s_), 1.0);
      const double assumed_s = kAssumed_share * phase.work_s;
      const Level kind = phase.kind.empty() ? job : level(find(kinds_, phase.kind), assumed_s, job.ratio);
      const Level name = level(find(names_, phase.what), assumed_s, kind.ratio);
      const double duration_s = share * phase.work_s * name.ratio;
      sum.add(duration_s);
      sum.deviate_alone(duration_s * relative_sd(phase.spread));
      double deviating_s = duration_s;
      sum.deviate_with("name " + phase.what, deviating_s * relative_sd(std::hypot(kName_sd * std::sqrt(name.assumed), name.measured_sd)));
      deviating_s *= name.assumed;
      if (!phase.kind.empty()) {
        sum.deviate_with("kind " + phase.kind, deviating_s * relative_sd(std::hypot(kKind_sd * std::sqrt(kind.assumed), kind.measured_sd)));
        deviating_s *= kind.assumed;
      }
      sum.deviate_with("job", deviating_s * relative_sd(std::hypot(kJob_sd * std::sqrt(job.assumed), job.measured_sd)));
      return duration_s;
    }

   private:
    static constexpr double kAssumed_share = 0.02;  ///< the first reports of a job, a kind and a name do not decide alone
    // Standard deviations of the logarithm of an unmeasured speed: of the computer (assumed: within a factor of four of the usual one); of
    // a kind relative to another, and of a name relative to its kind (44 calibrations).
    static constexpr double kJob_sd = 0.7;
    static constexpr double kKind_sd = 0.45;
    static constexpr double kName_sd = 0.3;

    /// Speed of a name, a kind or the job.
    struct Level {
      double ratio = 1.0;        ///< measured duration relative to the expected one
      double assumed = 1.0;      ///< weight of the assumed speed in it; 1 if nothing is measured
      double measured_sd = 0.0;  ///< standard deviation of its logarithm, because the ended phases deviate by their spreads
    };
    static Level level(const Measured* measured, double assumed_s, double otherwise) {
      if (!measured || measured->work_s <= 0.0) {
        return {otherwise, 1.0};
      }
      return {ratio(*measured, otherwise, assumed_s), assumed_s / (assumed_s + measured->work_s),
              std::sqrt(measured->variance_s2) / (assumed_s + measured->work_s)};
    }
    static const Measured* find(const std::map<std::string, Measured>& all, const std::string& key) {
      const auto same = all.find(key);
      return same == all.end() ? nullptr : &same->second;
    }

    std::map<std::string, Measured> names_;
    std::map<std::string, Measured> kinds_;
    Measured job_;
    double later_s_ = 0.0;
  };

  /// Returns the possible remaining times at the measured speeds.
  [[nodiscard]] std::vector<Outcome> outcomes(double time_s) const {
    const double later_s = std::accumulate(later.begin(), later.end(), (1.0 - share) * present->work_s,
                                           [](double sum_s, const auto& each) { return sum_s + each.probability * each.work_s; });
    const Speeds speeds(measured(), later_s);
    // Without reports a phase proceeds at its speed. One that takes longer than expected is assumed to take another fifth of that time.
    constexpr double kOverrun_ratio = 0.2;
    const double silent_s = time_s - report_s;
    UncertainSum sum;
    const double rest_s = speeds.add(*present, 1.0 - share, sum);
    sum.add((share < 1.0 ? std::max(rest_s - silent_s, kOverrun_ratio * silent_s) : 0.0) - rest_s);
    std::vector<JobPhase> phases = later;
    std::ranges::stable_sort(phases, std::ranges::greater(), &JobPhase::probability);
    std::vector<Outcome> all;
    double probability = 1.0;
    for (const JobPhase& each : phases) {
      if (each.probability < probability) {
        all.push_back({sum.median_s(), sum.log_sd(), probability - each.probability});
        probability = each.probability;
      }
      speeds.add(each, 1.0, sum);
    }
    all.push_back({sum.median_s(), sum.log_sd(), probability});
    return all;
  }

  void end_present(double time_s) {
    if (present) {
      Measured& own = ended[present->what];
      own.kind = present->kind;
      own.elapsed_s += time_s - present_begin_s;
      own.work_s += present->work_s;
      own.variance_s2 += std::pow(present->spread * present->work_s, 2.0);
      own.count += 1.0;
      present.reset();
    }
  }
};

JobProgress::JobProgress(Now now) : state_(std::make_shared<State>()) {
  state_->now = std::move(now);
  state_->begin_s = state_->now();
}

void JobProgress::expect(std::vector<JobPhase> later, bool is_open) const {
  if (state_) {
    const std::lock_guard lock(state_->mutex);
    state_->later = std::move(later);
    state_->is_open = is_open;
  }
}

void JobProgress::resize(double work_s, double spread) const {
  if (state_) {
    const std::lock_guard lock(state_->mutex);
    if (state_->present) {
      state_->present->work_s = work_s;
      state_->present->spread = spread;
    }
  }
}

Progress JobProgress::begin(const std::string& what) const {
  if (!state_) {
    return {};
  }
  State& state = *state_;
  const std::lock_guard lock(state.mutex);
  const double time_s = state.now();
  state.end_present(time_s);
  const auto expected = std::ranges::find(state.later, what, &JobPhase::what);
  if (expected == state.later.end()) {
    const auto same = state.ended.find(what);
    state.present =
        same == state.ended.end() ? JobPhase{what} : JobPhase{what, same->second.work_s / same->second.count, 1.0, same->second.kind};
  } else {
    state.present = *expected;
    state.later.erase(state.later.begin(), std::next(expected));
  }
  state.present_begin_s = state.report_s = time_s;
  state.share = 0.0;
  return [own = state_](std::size_t done, std::size_t total) {
    const std::lock_guard report(own->mutex);
    own->report_s = own->now();
    own->share = total > 0 ? std::min(1.0, static_cast<double>(done) / static_cast<double>(total)) : 0.0;
  };
}

JobEstimate JobProgress::estimate() const {
  JobEstimate found;
  if (!state_) {
    return found;
  }
  const State& state = *state_;
  const std::lock_guard lock(state.mutex);
  const double time_s = state.now();
  found.elapsed_s = time_s - state.begin_s;
  if (!state.present) {
    return found;
  }
  found.what = state.present->what;
  const std::vector<Outcome> outcomes = state.outcomes(time_s);
  const auto at = [&](double probability) { return quantile_s(outcomes, probability); };
  found.remaining = RemainingTime{at(0.025), at(0.5), at(0.975)};
  const double mean_s = std::accumulate(outcomes.begin(), outcomes.end(), 0.0,
                                        [](double sum_s, const Outcome& each) { return sum_s + each.probability * each.median_s; });
  found.done_share = found.elapsed_s > 0.0 ? found.elapsed_s / (found.elapsed_s + mean_s) : 0.0;
  found.is_open = state.is_open || state.present->work_s == 0.0;
  return found;
}

}  // namespace heatsoak::base
