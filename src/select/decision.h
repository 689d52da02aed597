// Decides whether a verdict has enough samples, and how many more it needs.
#pragma once

#include <span>
#include <vector>

#include "select/evaluate.h"
#include "select/round_plan.h"

namespace heatsoak::select {

/// Returns the number of samples of the first look of evaluate_until_decided(). If no sample exceeds a limit, this number suffices to
/// decide that the probability is at most kMarginalProbability; 72 independent draws are needed at the error of that look. `is_drawn`: the
/// duty draws games.
int first_samples(bool is_drawn);

/// Returns the probability of a wrong verdict that a look after `count` independent draws (games, or samples of a duty without draws) may
/// spend: half of kError_share up to the first look, a seventh of the other half for each later look. evaluate_until_decided() makes at
/// most five later looks (one on a duty with draws); two remain for a caller who requests more samples. All looks together spend at most
/// kError_share, so draws may be added until the verdict is decided (alpha spending: Jennison and Turnbull 2000, chapter 7; Bonferroni's
/// inequality bounds the sum). The result depends only on the count, so the same samples always give the same verdict.
double error_share(int count, bool is_drawn);

/// Returns the number of samples at which the interval of the probability would exclude the threshold of the verdict, if the probability
/// did not change; at most most_samples_at_all(). Returns nothing if the verdict is decided: the interval covers no threshold, or nominal
/// values alone decide. If `is_drawn`, the duty has draws, and kMajority is a second threshold.
std::optional<int> samples_needed(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn);

/// Numbers of samples with which the verdict is decided with a probability of 50 % and 90 %, counting the samples so far. Empty if not even
/// most_samples_at_all() reach the probability.
struct DecidingSamples {
  std::optional<int> half;
  std::optional<int> nine_in_ten;
};
/// Predicts them from the samples so far. samples_needed() takes the observed share as the true one. Near a threshold it is several times
/// too large, because a slightly different share needs far fewer samples. Here the true share is uncertain. Its distribution follows from
/// Jeffreys' prior and the samples so far, with each game counted as one sample (predictive probability: Spiegelhalter et al. 1986). If the
/// share over the limit and the share short of the demand are both open, the probability is that of deciding both; the shares are taken as
/// independent. Both members are empty if the verdict is decided.
DecidingSamples deciding_samples(const MotorEvaluation& motor);

/// Work of the rounds that double the samples of open motors, from `samples` on: sums over rounds and motors. `needed`: per open motor, its
/// samples_needed(); a motor that has that many takes part in no further round. `most`: largest number of samples of the last round.
struct LaterWork {
  double evaluations_count = 0.0;
  double samples_count = 0.0;
};
LaterWork later_work(std::span<const int> needed, int samples, int most);

/// Returns the largest number of samples per motor that evaluate_until_decided() uses by default, some seconds of work. It is a count and
/// not a time, so that the same command gives the same answer on every computer.
int most_samples(const duty::Duty& duty);

/// Returns the largest number of samples that a user can request. A drawn game takes 0.6 MB and 0.1 s, which limits the number.
int most_samples_at_all(bool is_drawn);

/// Draws demands as draw_demands() does, evaluates with `options.samples`, then doubles the samples of the motors whose verdict is not
/// decided, up to `most`. On a duty with draws, where games take nearly all of the time, only motors that `most` samples would decide get
/// more samples. A longer round starts with the samples of the shorter one. `draws` receives all drawn demands; `options.draws` is not
/// used. The result is sorted as by evaluate().
std::vector<MotorEvaluation> evaluate_until_decided(const robot::Robot& robot, const duty::Duty& duty,
                                                    std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                    EvaluateOptions options, int most, std::vector<duty::WheelDemand>& draws,
                                                    const RoundsProgress& progress = {});

}  // namespace heatsoak::select
