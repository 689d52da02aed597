// Whether the samples decide a verdict, and how many more it takes where they do not.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak {

/// The number of samples at which the 95 % interval of the probability would no longer cover the threshold that the verdict depends on,
/// if the probability stayed as it is: the width of an interval falls with the root of the number of samples. At most `kMostNeeded`.
/// Nothing where the verdict is decided: the interval covers no threshold, or nominal values alone decide. `is_drawn`: the duty has draws
/// of its own, so that kMajority is a threshold too.
inline constexpr int kMostNeeded = 1'000'000;
std::optional<int> samples_needed(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn);

/// The most samples that evaluate_until_decided() takes for a motor: some seconds of work without draws, a minute or two with them.
int most_samples(const Duty& duty);

/// A progress of its own for every round of work, by its name.
using ProgressFor = std::function<Progress(const char* what)>;

/// Draws demands as draw_demands() does, evaluates with `options.samples`, then doubles the samples of the motors whose verdict is not
/// decided, up to most_samples(duty). The first samples of a longer round are those of the shorter one. `draws` receives all drawn
/// demands; `options.draws` is not used. Sorted as by evaluate().
std::vector<MotorEvaluation> evaluate_until_decided(const Robot& robot, const Duty& duty, std::span<const WheelDemand> wheels,
                                                    std::span<const Motor> motors, EvaluateOptions options, int most,
                                                    std::vector<WheelDemand>& draws, const ProgressFor& progress = {});

}  // namespace heatsoak
