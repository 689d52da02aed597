// Expected durations of the rounds of an evaluation, for its progress.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/job_progress.h"
#include "select/evaluate.h"
#include "select/prospect.h"

namespace heatsoak::select {

/// Return the usual durations in s on two cores for a match: of one drawn game, and of the evaluation of `motors_count` motors. Only their
/// ratios matter once work has been measured.
inline constexpr double kDraw_s = 0.035;
double evaluation_work_s(double motors_count, int samples);

/// Progress of an evaluation that may be a part of a longer job.
struct RoundsProgress {
  base::JobProgress job = {};
  /// Returns the phases that follow an evaluation with these prospects, which are empty if nothing is known yet. May be null.
  std::function<std::vector<base::JobPhase>(std::span<const Prospect>)> later = {};
};

/// Declares the phases of evaluate_until_decided(): the first round, and the later ones with their probabilities. Refers to all arguments
/// of its constructor.
class RoundPlan {
 public:
  RoundPlan(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
            std::span<const motor::Motor> motors, int most, const RoundsProgress& progress);

  /// Declares the first round. If progress of a job with drawn games is shown, a few games are played first, and some motors are evaluated
  /// in them, to estimate the durations of the rounds. `draws` receives these games, which the first round needs anyway.
  void foresee(const EvaluateOptions& options, std::vector<duty::WheelDemand>& draws) const;
  /// Declares the later rounds from the results of a round with `samples` samples.
  void update(std::span<const MotorEvaluation> results, int samples) const;
  /// Begins the games of a round.
  [[nodiscard]] base::Progress playing() const;
  /// Begins the evaluations of a round.
  [[nodiscard]] base::Progress evaluating(std::size_t motors, int samples) const;

 private:
  [[nodiscard]] std::vector<base::JobPhase> round(double motors_count, int samples, int draws) const;
  /// Declares `certain` phases, then those that may follow a round with `samples` samples.
  void expect(std::vector<base::JobPhase> certain, std::span<const Prospect> prospects, int samples) const;

  const robot::Robot& robot_;
  const duty::Duty& duty_;
  std::span<const duty::WheelDemand> wheels_;
  std::span<const motor::Motor> motors_;
  int most_ = 0;
  const RoundsProgress& progress_;
};

}  // namespace heatsoak::select
