#include "calibration/followed_signals.h"

#include <algorithm>

#include "estimation/open_loop.h"

namespace heatsoak::calibration {
namespace {

/// Error that is too large for any use of the model.
constexpr double kFar_K = 20.0;
/// A smaller error is no sign of wrong logs, even if the signal hardly varies.
constexpr double kUsual_K = 10.0;

}  // namespace

std::vector<PoorFit> not_followed(const std::map<std::string, double>& rmse_K, std::span<const estimation::MeasuredRun> runs,
                                  double far_share) {
  std::vector<PoorFit> found;
  for (const auto& [signal, error_K] : rmse_K) {
    const double varies_K = estimation::standard_deviation_K(runs, signal);
    if (error_K > std::max(kUsual_K, varies_K) || error_K > std::max(kFar_K, far_share * varies_K)) {
      found.push_back({signal, error_K, varies_K});
    }
  }
  return found;
}

NothingFollows::NothingFollows(Tried tried, std::vector<PoorFit> signals, bool has_speed)
    : base::Failure(base::ExitCode::cannot_answer, tried == Tried::parameters ? "no parameter values make the model follow these logs"
                                                                              : "no effect makes the model follow these logs"),
      signals_(std::move(signals)),
      has_speed_(has_speed) {}

}  // namespace heatsoak::calibration
