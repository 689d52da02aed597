// Whether the samples decide a verdict, and how many more it takes where they do not.
#pragma once

#include <span>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::select {

/// The first look of evaluate_until_decided(). Without a hit it decides that a share is at most kMarginalProbability, which takes 72
/// independent draws at the error of that look.
int first_samples(const duty::Duty& duty);

/// The chance of a wrong verdict that a look after `count` independent draws (games, or samples of a duty without draws) may spend: half of
/// kError_share up to the first look, a seventh of the other half for each look behind it. evaluate_until_decided() makes five of them at
/// most (one on a duty with draws), which leaves two for a caller who asks for more. All looks together spend at most kError_share, so that
/// draws may be added until the verdict is decided (alpha spending: Jennison and Turnbull 2000, chapter 7; the looks are added up by
/// Bonferroni's inequality). It depends on the count alone: the same samples give the same verdict, however they were reached.
double error_share(int count, bool is_drawn);

/// The number of samples at which the interval of the probability would no longer cover the threshold that the verdict depends on, if the
/// probability stayed as it is. At most most_samples_at_all(): more cannot be asked for. Nothing where the verdict is decided: the interval
/// covers no threshold, or nominal values alone decide. `is_drawn`: the duty has draws of its own, so that kMajority is a threshold too.
std::optional<int> samples_needed(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn);

/// The most samples that evaluate_until_decided() takes for a motor by itself: some seconds of work. A count and not a time, so that the
/// same command gives the same answer on every computer.
int most_samples(const duty::Duty& duty);

/// The most samples that can be asked for. A drawn game takes 0.6 MB and a tenth of a second: memory and hours end there.
int most_samples_at_all(bool is_drawn);

/// Draws demands as draw_demands() does, evaluates with `options.samples`, then doubles the samples of the motors whose verdict is not
/// decided, up to `most`. On a duty with draws, whose games take nearly all of the time, only a motor that `most` samples would decide
/// takes part. The first samples of a longer round are those of the shorter one. `draws` receives all drawn demands; `options.draws` is not
/// used. Sorted as by evaluate().
std::vector<MotorEvaluation> evaluate_until_decided(const robot::Robot& robot, const duty::Duty& duty,
                                                    std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                    EvaluateOptions options, int most, std::vector<duty::WheelDemand>& draws,
                                                    const base::ProgressFor& progress = {});

}  // namespace heatsoak::select
