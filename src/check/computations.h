// Results that thresholds are compared with. Each is computed once and kept for the next threshold that needs it.
#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "check/check_file.h"
#include "check/not_evaluated.h"
#include "derate/derating.h"
#include "select/evaluate.h"
#include "simulate/match_run.h"

namespace heatsoak::check {

/// Values by key. The first caller computes the value of a key, others wait for it. A Failure or NotEvaluated is kept and thrown to every
/// caller.
template <class T>
class Kept {
 public:
  const T& get(const std::string& key, const std::function<T()>& make) {
    Place* place = nullptr;
    {
      const std::lock_guard lock(mutex_);
      std::unique_ptr<Place>& own = places_[key];
      if (!own) {
        own = std::make_unique<Place>();
      }
      place = own.get();
    }
    const std::lock_guard lock(place->mutex);
    if (!place->value && !place->failure) {
      try {
        place->value.emplace(make());
      } catch (const base::Failure&) {
        place->failure = std::current_exception();
      } catch (const NotEvaluated&) {
        place->failure = std::current_exception();
      }
    }
    if (place->failure) {
      std::rethrow_exception(place->failure);
    }
    return *place->value;
  }

 private:
  struct Place {
    std::mutex mutex;
    std::optional<T> value;
    std::exception_ptr failure;
  };
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<Place>> places_;
};

/// Match of a check, driven by the drive core with its thermal guard in shadow mode: the guard reports what it would limit, but limits
/// nothing.
struct GuardedDrive {
  simulate::DriveScore score;
  double duration_s = 0.0;
};

/// A result that limits need. Checks with the same key share it.
struct UsualWork {
  enum class Kind { games, drive, other };
  Kind kind = Kind::other;
  std::string key;
  double usual_s = 0.0;
};

/// Returns whether the threshold needs Computations::guarded_drive().
bool needs_drive(const ThresholdType& type);

/// Thread-safe. The check must have the settings that a function reads (ThresholdType::needs). Functions throw NotEvaluated or
/// Failure if there is no result.
class Computations {
 public:
  /// Called when a part of a check's work is done, which usually takes `work_s` on two cores.
  using Worked = std::function<void(const Check& check, double work_s)>;

  explicit Computations(int threads, Worked worked = {}) : threads_(threads), worked_(std::move(worked)) {}

  /// Plays the games of the check on all threads. Without this call, checks that run at the same time and need the same games would wait
  /// for one of them, which plays them alone. A failure is kept for the threshold that needs the games.
  void play_games(const Check& check, const base::Progress& progress = {});

  /// Returns the usual durations on two cores of what the limits of a check need; for progress.
  [[nodiscard]] static std::vector<UsualWork> usual_work(const Check& check);

  /// Returns the evaluation of `motor` alone on the check's robot and duty. `heatsoak evaluate` gives the same numbers, whatever motors it
  /// compares.
  const select::MotorEvaluation& evaluation(const Check& check, const motor::Motor& motor);
  /// Returns the evaluation of the check's motor. Throws NotEvaluated if the motor cannot deliver the demand, because its temperatures are
  /// then meaningless.
  const select::MotorEvaluation& feasible_evaluation(const Check& check);
  /// Returns the number of independent draws: games if the duty is drawn, else samples.
  [[nodiscard]] static int independent_draws(const Check& check);
  /// Returns the demand of the duty for the check's seed, one per wheel.
  const std::vector<duty::WheelDemand>& demand(const Check& check);
  const derate::Derating& derating(const Check& check, const derate::DerateOptions& options);
  const GuardedDrive& guarded_drive(const Check& check);

 private:
  const std::vector<duty::WheelDemand>& draws(const Check& check, const base::Progress& progress = {});
  /// Reports the finished share of a work of `all_s` to worked_.
  [[nodiscard]] base::Progress reporting(const Check& check, double all_s) const;
  /// Returns the nominal game of a match, which gives the demand and is driven. Throws NotEvaluated if the duty is no match.
  const duty::MatchLoad& nominal_game(const Check& check);

  int threads_ = 0;
  Worked worked_;
  Kept<duty::MatchLoad> nominal_games_;
  Kept<std::vector<duty::WheelDemand>> demands_;
  Kept<std::vector<duty::WheelDemand>> draws_;
  Kept<select::MotorEvaluation> evaluations_;
  Kept<derate::Derating> deratings_;
  Kept<GuardedDrive> drives_;
};

}  // namespace heatsoak::check
