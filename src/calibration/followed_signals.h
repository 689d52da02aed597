// Checks whether a fitted model follows the runs. If not, its parameters and effects would be meaningless.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "calibration/findings.h"
#include "estimation/measured_run.h"

namespace heatsoak::calibration {

/// Share of its variation from which an error of more than 20 K is too large.
inline constexpr double kFar_share = 0.4;

/// Returns the signals that a model does not follow: with an error above both 10 K and the standard deviation of the signal, or above both
/// 20 K and `far_share` of that deviation. `rmse_K` per signal, over all runs.
std::vector<PoorFit> not_followed(const std::map<std::string, double>& rmse_K, std::span<const estimation::MeasuredRun> runs,
                                  double far_share = kFar_share);

/// Neither parameter values nor effects make the model follow the logs (cannot_answer).
class NothingFollows : public base::Failure {
 public:
  enum class Tried { parameters, effects };
  NothingFollows(Tried tried, std::vector<PoorFit> signals, bool has_speed);
  [[nodiscard]] const std::vector<PoorFit>& signals() const { return signals_; }
  /// False if the loss at speed is unknown, because a log lacks the speed.
  [[nodiscard]] bool has_speed() const { return has_speed_; }

 private:
  std::vector<PoorFit> signals_;
  bool has_speed_;
};

}  // namespace heatsoak::calibration
