// Progress of a whole job: its phases with their expected durations, and the remaining time that follows from the work done so far.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"

namespace heatsoak::base {

/// Usual standard deviation of the natural logarithm of a phase's duration at a measured speed: that of the fits of the response without
/// one run, relative to the fit to all runs, in 44 calibrations.
inline constexpr double kUsualSpread_sd = 0.18;

/// Part of a job.
struct JobPhase {
  std::string what;          ///< name for the user; phases of the same name are work of the same kind
  double work_s = 0.0;       ///< expected duration in s on a usual computer
  double probability = 1.0;  ///< probability that the phase takes place
  std::string kind = {};     ///< kind of work, whose measured speed counts until that of `what` is measured; may be empty
  /// Standard deviation of the natural logarithm of the duration at a measured speed, for example because the number of steps is unknown.
  double spread = kUsualSpread_sd;
};

/// Quantiles of a remaining time: 2.5 % of the jobs end before `p025_s`.
struct RemainingTime {
  double p025_s = 0.0;
  double p50_s = 0.0;
  double p975_s = 0.0;
};

struct JobEstimate {
  std::string what;                             ///< name of the present phase; empty before the first one
  double elapsed_s = 0.0;                       ///< since the job began
  double done_share = 0.0;                      ///< elapsed time divided by the mean total time, 0 to 1
  std::optional<RemainingTime> remaining = {};  ///< remaining time of the whole job; empty before the first phase
  bool is_open = false;                         ///< more phases of unknown length may follow, so that there is no longest time
};

/// Handle of a job's progress; copies refer to the same job. All members may be called from any thread. A default-constructed handle
/// ignores all calls.
///
/// Once work has been measured, only the ratios of the expected durations count. Each name of a phase is scaled by its own measured speed;
/// a name that has not begun by that of its kind, and a kind that has not begun by the mean speed of the job.
///
/// If phases may be left out, the remaining time has several values, each with a probability. A phase is taken to follow only together with
/// all phases that are more probable. Each value is uncertain by the spreads of its phases and by the speeds that are not measured yet. The
/// spreads are independent, so their variances add; phases of the same unknown speed deviate together. Each value is log-normal.
class JobProgress {
 public:
  using Now = std::function<double()>;  ///< returns a time in s that never decreases

  JobProgress() = default;
  /// Begins a job.
  explicit JobProgress(Now now);

  /// True if somebody watches the job.
  explicit operator bool() const { return state_ != nullptr; }

  /// Sets the phases that follow the present one, in order. `is_open`: more phases of unknown length may follow.
  void expect(std::vector<JobPhase> later, bool is_open = false) const;
  /// Changes the expected work of the present phase. `spread`: standard deviation of the logarithm of its unfinished part.
  void resize(double work_s, double spread = kUsualSpread_sd) const;
  /// Ends the present phase and begins the first expected phase of this name; expected phases before it are left out. A phase that was not
  /// expected takes as much work as an earlier one of its name, if there was one, and the expected ones remain. Returns the progress of the
  /// phase, which may be ignored.
  Progress begin(const std::string& what) const;  // NOLINT(modernize-use-nodiscard)

  [[nodiscard]] JobEstimate estimate() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace heatsoak::base
