#include "calibration/error_before_after.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::calibration {

std::vector<ErrorBeforeAfter> errors_over_runs(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after) {
  std::vector<ErrorBeforeAfter> all;
  const auto add = [&](const std::vector<PredictedRun>& runs, estimation::SignalError ErrorBeforeAfter::*when) {
    for (const PredictedRun& run : runs) {
      for (const PredictedSignal& each : run.signals) {
        auto found = std::ranges::find(all, each.signal, &ErrorBeforeAfter::signal);
        if (found == all.end()) {
          found = all.insert(all.end(), {each.signal, {each.signal}, {each.signal}});
        }
        estimation::SignalError& error = (*found).*when;
        const auto more = static_cast<double>(each.samples);
        const double count = static_cast<double>(error.samples) + more;
        error.rmse_K =
            count > 0.0 ? std::sqrt((error.rmse_K * error.rmse_K * (count - more) + each.rmse_K * each.rmse_K * more) / count) : 0.0;
        error.max_abs_K = std::max(error.max_abs_K, each.max_abs_K);
        error.samples += static_cast<Eigen::Index>(each.samples);
      }
    }
  };
  add(before, &ErrorBeforeAfter::before);
  add(after, &ErrorBeforeAfter::after);
  return all;
}

std::vector<ErrorBeforeAfter> worst_errors(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after) {
  std::vector<ErrorBeforeAfter> worst;
  for (std::size_t r = 0; r < after.size(); ++r) {
    for (const ErrorBeforeAfter& each : errors_over_runs({before[r]}, {after[r]})) {
      const auto found = std::ranges::find(worst, each.signal, &ErrorBeforeAfter::signal);
      if (found == worst.end()) {
        worst.push_back(each);
      } else if (each.after.rmse_K > found->after.rmse_K) {
        *found = each;
      }
    }
  }
  return worst;
}

double rms_error_K(std::span<const PredictedRun> runs) {
  double squares_K2 = 0.0;
  double count = 0.0;
  for (const PredictedRun& run : runs) {
    for (const PredictedSignal& each : run.signals) {
      squares_K2 += each.rmse_K * each.rmse_K;
      count += 1.0;
    }
  }
  return std::sqrt(squares_K2 / std::max(1.0, count));
}

}  // namespace heatsoak::calibration
