#include "diagnosis/holdout_score.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace heatsoak::diagnosis {

HoldoutScore score_holdout(const ScoredFiles& files, const std::vector<recording::Recording>& holdout,
                           const calibration::PredictionOptions& options) {
  HoldoutScore score;
  if (holdout.empty()) {
    return score;
  }
  score.runs_before = calibration::predict(files.before, holdout, options).runs;
  score.runs_refitted = calibration::predict(files.refitted, holdout, options).runs;
  score.runs_after = calibration::predict(files.after, holdout, options).runs;
  for (std::size_t r = 0; r < score.runs_after.size(); ++r) {
    for (std::size_t s = 0; s < score.runs_after[r].signals.size(); ++s) {
      const auto error_of = [&](const std::vector<calibration::PredictedRun>& runs) {
        return estimation::ErrorOfSignal{runs[r].signals[s].rmse_K, runs[r].signals[s].max_abs_K};
      };
      score.errors.push_back({score.runs_after[r].name, score.runs_after[r].signals[s].signal, error_of(score.runs_before),
                              error_of(score.runs_refitted), error_of(score.runs_after), error_of(score.runs_after)});
    }
  }
  return score;
}

double rms_of_run_K(const HoldoutScore& score, const std::string& run, estimation::ErrorOfSignal ErrorInRun::*file) {
  double squares_K2 = 0.0;
  int count = 0;
  for (const ErrorInRun& each : score.errors) {
    if (each.run == run) {
      squares_K2 += std::pow((each.*file).rmse_K, 2);
      ++count;
    }
  }
  return std::sqrt(squares_K2 / std::max(1, count));
}

}  // namespace heatsoak::diagnosis
