#include "base/job_progress.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

namespace heatsoak::base {
namespace {

/// A possible remaining time.
struct Outcome {
  double remaining_s = 0.0;
  double probability = 0.0;
};

/// Returns the least remaining time that the true one does not exceed with the given probability.
double quantile_s(const std::vector<Outcome>& ascending, double probability) {
  double sum = 0.0;
  for (const Outcome& each : ascending) {
    sum += each.probability;
    if (sum >= probability) {
      return each.remaining_s;
    }
  }
  return ascending.back().remaining_s;
}

/// Returns the geometric middle of the most probable times whose ends differ by at most a factor of two.
double likely_remaining_s(const std::vector<Outcome>& ascending) {
  constexpr double kWidest_ratio = 2.0;  // the middle is within 1.4 of both ends; the rest of a factor of two is for the speed
  constexpr double kShortest_s = 1.0;  // shorter times need no distinction
  double best = 0.0;
  double likely_s = 0.0;
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    const double from_s = std::max(kShortest_s, ascending[i].remaining_s);
    double to_s = from_s;
    double probability = 0.0;
    for (std::size_t k = i; k < ascending.size() && ascending[k].remaining_s <= kWidest_ratio * from_s; ++k) {
      probability += ascending[k].probability;
      to_s = std::max(from_s, ascending[k].remaining_s);
    }
    if (probability > best) {
      best = probability;
      likely_s = std::sqrt(from_s * to_s);
    }
  }
  return likely_s;
}

}  // namespace

struct JobProgress::State {
  /// Measured work of phases of one name.
  struct Measured {
    std::string kind;
    double elapsed_s = 0.0;
    double work_s = 0.0;  ///< its expected duration
    double count = 0.0;   ///< number of ended phases
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

  /// Returns the duration of a phase at the measured speeds.
  class Speeds {
   public:
    Speeds(std::map<std::string, Measured> names, double later_s) : names_(std::move(names)) {
      Measured job;
      for (const auto& [what, measured] : names_) {
        for (Measured* const sum : {&job, &kinds_[measured.kind]}) {
          sum->elapsed_s += measured.elapsed_s;
          sum->work_s += measured.work_s;
        }
      }
      job_ratio_ = ratio(job, 1.0, kAssumed_share * (job.work_s + later_s));
    }
    [[nodiscard]] double duration_s(const JobPhase& phase) const {
      const double assumed_s = kAssumed_share * phase.work_s;
      const auto ratio_in = [&](const std::map<std::string, Measured>& all, const std::string& key, double otherwise) {
        const auto same = all.find(key);
        return same == all.end() ? otherwise : ratio(same->second, otherwise, assumed_s);
      };
      const double kind_ratio = phase.kind.empty() ? job_ratio_ : ratio_in(kinds_, phase.kind, job_ratio_);
      return phase.work_s * ratio_in(names_, phase.what, kind_ratio);
    }

   private:
    static constexpr double kAssumed_share = 0.02;  ///< the first reports of a job, a kind and a name do not decide alone
    std::map<std::string, Measured> names_;
    std::map<std::string, Measured> kinds_;
    double job_ratio_ = 1.0;
  };

  /// Returns the possible remaining times at the measured speeds, in ascending order.
  [[nodiscard]] std::vector<Outcome> outcomes(double time_s) const {
    const double later_s = std::accumulate(later.begin(), later.end(), (1.0 - share) * present->work_s,
                                           [](double sum_s, const auto& each) { return sum_s + each.probability * each.work_s; });
    const Speeds speeds(measured(), later_s);
    // Without reports a phase proceeds at its speed. One that takes longer than expected is assumed to take another fifth of that time.
    constexpr double kOverrun_ratio = 0.2;
    const double silent_s = time_s - report_s;
    const double rest_s = (1.0 - share) * speeds.duration_s(*present);
    std::vector<JobPhase> phases = later;
    std::ranges::stable_sort(phases, std::ranges::greater(), &JobPhase::probability);
    std::vector<Outcome> all;
    Outcome next{share < 1.0 ? std::max(rest_s - silent_s, kOverrun_ratio * silent_s) : 0.0, 1.0};
    for (const JobPhase& each : phases) {
      if (each.probability < next.probability) {
        all.push_back({next.remaining_s, next.probability - each.probability});
        next.probability = each.probability;
      }
      next.remaining_s += speeds.duration_s(each);
    }
    all.push_back(next);
    return all;
  }

  void end_present(double time_s) {
    if (present) {
      Measured& own = ended[present->what];
      own.kind = present->kind;
      own.elapsed_s += time_s - present_begin_s;
      own.work_s += present->work_s;
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

void JobProgress::resize(double work_s) const {
  if (state_) {
    const std::lock_guard lock(state_->mutex);
    if (state_->present) {
      state_->present->work_s = work_s;
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
  constexpr double kImprobable = 0.1;
  const std::vector<Outcome> outcomes = state.outcomes(time_s);
  found.shortest_s = quantile_s(outcomes, kImprobable);
  found.longest_s = quantile_s(outcomes, 1.0 - kImprobable);
  found.likely_s = likely_remaining_s(outcomes);
  const double mean_s = std::accumulate(outcomes.begin(), outcomes.end(), 0.0,
                                        [](double sum_s, const Outcome& each) { return sum_s + each.probability * each.remaining_s; });
  found.done_share = found.elapsed_s > 0.0 ? found.elapsed_s / (found.elapsed_s + mean_s) : 0.0;
  found.is_open = state.is_open || state.present->work_s == 0.0;
  return found;
}

}  // namespace heatsoak::base
