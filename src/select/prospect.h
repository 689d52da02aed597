// Predicts how an evaluation goes on: when its verdict will be decided, and whether the motor will pass.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::select {

/// Kinds of shares: samples over a temperature limit, and samples that miss the demand.
inline constexpr std::size_t kShareOver = 0;
inline constexpr std::size_t kShareShort = 1;

/// A threshold that the interval of a share covers; `kind` is kShareOver or kShareShort.
struct OpenThreshold {
  double threshold_ratio = 0.0;
  double share_ratio = 0.0;
  std::size_t kind = 0;
};
/// Returns the thresholds of the verdict that the intervals cover, the majority first; none if the verdict is decided. On a duty with draws
/// (`is_drawn`) the majority counts too.
std::vector<OpenThreshold> open_thresholds(const MotorEvaluation& motor, bool is_drawn);

/// The shares that decide the verdict of a motor, as quantiles of their distributions.
class Prospect {
 public:
  /// Predicts from all samples so far. The distribution of a share follows from Jeffreys' prior and the samples so far, with each game
  /// counted as one sample (predictive probability: Spiegelhalter et al. 1986).
  explicit Prospect(const MotorEvaluation& motor);

  /// Predicts from the first games of an evaluation, which are too few to count samples over a limit. Assumes that the peak temperature
  /// above the air is log-normally distributed. The share over the limit follows from the median and the scatter of the samples; the
  /// median is as uncertain as that of one observation per game.
  static Prospect of_few_games(const MotorEvaluation& few, double ambient_C);

  [[nodiscard]] const std::string& motor_id() const { return motor_id_; }

  /// Returns the probability that `samples` samples in total decide the verdict; 1 if it is decided. If both shares are open, the
  /// probability is that of deciding both; the shares are taken as independent.
  [[nodiscard]] double decided_probability(int samples) const;

  /// Returns the probability that the rounds of evaluate_until_decided() end at `samples` samples at the latest: the verdict is decided
  /// then, or `most` samples will probably not decide it (may_be_decided_by()). Without draws only a decision ends them.
  [[nodiscard]] double ended_probability(int samples, int most) const;

  /// Returns the probability that the verdict will be pass.
  [[nodiscard]] double pass_probability() const;

  /// Returns the number of samples that decide with the probability: at most 5 % more than the smallest, and at most
  /// most_samples_at_all(). Empty if the verdict is decided, or if that number does not suffice.
  [[nodiscard]] std::optional<int> deciding_samples(double probability_ratio) const;

 private:
  static constexpr std::size_t kQuantiles = 64;
  /// A share with the thresholds that it must leave.
  struct Share {
    std::array<double, kQuantiles> quantiles_ratio{};
    std::vector<double> thresholds_ratio;
    double seen_count = 0.0;  ///< draws that count for the share so far
  };

  Prospect() = default;
  [[nodiscard]] double decided_by_draws(int draws) const;
  [[nodiscard]] int per_draw() const;

  std::string motor_id_;
  bool is_drawn_ = true;
  int draws_ = 0;               ///< draws so far
  std::optional<bool> passes_;  ///< verdict if it is decided
  std::vector<Share> open_;     ///< shares whose side of a threshold is open
};

}  // namespace heatsoak::select
