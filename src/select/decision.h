// Decides whether a verdict has enough samples, and how many more it needs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "select/evaluate.h"
#include "select/prospect.h"
#include "select/round_plan.h"

namespace heatsoak::select {

/// Returns the number of samples after which evaluate_until_decided() first tests whether the verdict is decided; such a test is a look. If
/// no sample exceeds a limit, this number suffices to decide that the probability is at most kMarginalProbability.
int first_samples(bool is_drawn);

/// evaluate_until_decided() doubles the number of samples at most this many times.
inline constexpr int kMostDoublings = 5;
/// Looks after the first one that the error share allows for. Those that evaluate_until_decided() does not use remain for a caller who
/// requests more samples.
inline constexpr int kLaterLooks = kMostDoublings + 2;

/// Returns the probability of a wrong verdict that a look after `count` independent draws may spend. A draw is a game, or a sample of a
/// duty without draws. All looks up to the first one share half of kError_share. Each of kLaterLooks has an equal part of the other half.
/// All looks together spend at most kError_share, so draws may be added until the verdict is decided (alpha spending: Jennison and Turnbull
/// 2000, chapter 7; Bonferroni's inequality bounds the sum). The result depends only on the count, so the same samples always give the same
/// verdict.
double error_share(int count, bool is_drawn);

/// Returns the number of samples at which the interval of the probability would exclude the threshold of the verdict, if the probability
/// did not change; at most most_samples_at_all(). Returns nothing if the verdict is decided: the interval covers no threshold, or nominal
/// values alone decide. If `is_drawn`, the duty has draws, and kMajority is a second threshold.
std::optional<int> samples_needed(const MotorEvaluation& motor, bool is_drawn);

/// Sets verdict, limiting factor and samples_needed from the shares and their intervals. The verdict is marginal while the intervals cover
/// a threshold. Without draws the nominal run has decided fail and infeasible already.
void decide_by_samples(MotorEvaluation& motor, bool is_drawn);

/// Returns whether samples were drawn and more of them would not change the verdict.
inline bool is_decided(const MotorEvaluation& motor) { return motor.samples > 0 && !motor.samples_needed; }

/// Returns the verdict that JSON and ranking state. It does not depend on the number of samples until they decide: an undecided motor is
/// marginal, and so is one that only the nominal run passes (no samples). A motor that misses the demand or exceeds a limit for certain is
/// infeasible or fails, also while the other of the two is open.
Verdict stated_verdict(const MotorEvaluation& motor);

/// Returns whether `first` ranks before `second`: by verdict, then by nearest_margin_K().
bool ranks_before(const MotorEvaluation& first, const MotorEvaluation& second);

/// Returns the worst verdict that the samples still allow, for thresholds that must not pass by chance; stated_verdict() without samples.
Verdict worst_allowed_verdict(const MotorEvaluation& motor);

/// Probabilities of a decision for which deciding_samples() gives the numbers of samples.
inline constexpr double kEvenDecision_share = 0.5;
inline constexpr double kLikelyDecision_share = 0.9;
/// Numbers of samples with which the verdict is decided with these probabilities, counting the samples so far. Empty if not even
/// most_samples_at_all() reach the probability.
struct DecidingSamples {
  std::optional<int> half;
  std::optional<int> nine_in_ten;
};
/// Predicts these numbers from the samples so far (Prospect). Near a threshold they are several times smaller than samples_needed(), which
/// takes the observed share as the true one: a slightly different share needs far fewer samples. Empty if the verdict is decided.
DecidingSamples deciding_samples(const MotorEvaluation& motor);

/// Returns the largest number of samples per motor that evaluate_until_decided() uses by default: first_samples() after kMostDoublings. It
/// is a count and not a time, so that the same command gives the same answer on every computer.
int most_samples(bool is_drawn);
int most_samples(const duty::Duty& duty);

/// Smallest probability of a decision for which further games are played.
inline constexpr double kLeastDecision_share = 0.2;
/// Returns whether games up to `most` samples decide the verdict with at least that probability, and it is not decided yet.
bool may_be_decided_by(const Prospect& prospect, int most);

/// Returns the largest number of samples that a user can request. A drawn game takes 0.6 MB and 0.07 s of one core, which limits the
/// number.
int most_samples_at_all(bool is_drawn);

/// Draws demands as draw_demands() does, evaluates with `options.samples`, then doubles the samples of the motors whose verdict is not
/// decided, up to `most`. On a duty with draws, where games take nearly all of the time, a motor gets more samples only while
/// may_be_decided_by(). A longer round starts with the samples of the shorter one. `draws` receives all drawn demands; `options.draws`
/// is not used. The result is sorted as by evaluate().
std::vector<MotorEvaluation> evaluate_until_decided(const robot::Robot& robot, const duty::Duty& duty,
                                                    std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                    EvaluateOptions options, int most, std::vector<duty::WheelDemand>& draws,
                                                    const RoundsProgress& progress = {});

}  // namespace heatsoak::select
