#include "present/measured/diagnosis_reservations.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/quantity.h"
#include "estimation/thresholds.h"
#include "present/measured/run_words.h"

namespace heatsoak::present {
namespace {

/// Warns of the hold-out runs that the new file predicts worse than the original one or than the refitted one, and of single signals in
/// other runs.
std::string growth_in_holdout_runs(const diagnosis::HoldoutScore& score) {
  using Error = diagnosis::ErrorInRun;
  const auto is_worse = [&](const std::string& run, estimation::ErrorOfSignal Error::*than) {
    return diagnosis::is_plainly_worse(diagnosis::rms_of_run_K(score, run, &Error::after), diagnosis::rms_of_run_K(score, run, than));
  };
  std::string text;
  for (const calibration::PredictedRun& run : score.runs_after) {
    if (is_worse(run.name, &Error::before)) {
      text += fmt::format(" Do not use the new model for runs like {}: the error in this hold-out run grows.", run.name);
      continue;
    }
    if (is_worse(run.name, &Error::refitted)) {
      text += fmt::format(
          " In {}, the model with only its own parameters refitted predicts better, {} instead of {} K RMS: for such runs, use the file of "
          "heatsoak calibrate --innovations.",
          run.name, base::significant(diagnosis::rms_of_run_K(score, run.name, &Error::refitted), 2),
          base::significant(diagnosis::rms_of_run_K(score, run.name, &Error::after), 2));
      continue;
    }
    for (const Error& each : score.errors) {
      const bool is_best_before = each.before.rmse_K < each.refitted.rmse_K;
      const double best_K = std::min(each.before.rmse_K, each.refitted.rmse_K);
      if (each.run == run.name && diagnosis::is_plainly_worse(each.after.rmse_K, best_K)) {
        text += fmt::format(" The error of the {} alone grows in {}, from {} K{} to {} K.", part_of(each.signal), run.name,
                            base::significant(best_K, 2), is_best_before ? "" : " with only the model's own parameters refitted",
                            base::significant(each.after.rmse_K, 2));
      }
    }
  }
  return text;
}

std::string growth_in_training_runs(const diagnosis::Diagnosis& diagnosis) {
  if (diagnosis::is_plainly_worse(estimation::rms_K(diagnosis.after_train), estimation::rms_K(diagnosis.before_train))) {
    return " Keep the parameters of the original file: the error on the training runs grows.";
  }
  std::string text;
  for (const auto& [signal, error] : diagnosis.after_train) {
    const auto own = diagnosis.before_train.find(signal);
    if (own != diagnosis.before_train.end() && diagnosis::is_plainly_worse(error.rmse_K, own->second.rmse_K)) {
      text += fmt::format(" The error of the {} alone grows in the training runs, from {} to {} K.", part_of(signal),
                          base::significant(own->second.rmse_K, 2), base::significant(error.rmse_K, 2));
    }
  }
  return text;
}

}  // namespace

std::string reservations(const diagnosis::Diagnosis& diagnosis, const diagnosis::HoldoutScore& score) {
  constexpr double kElsewhere_ratio = 3.0;
  std::string text = growth_in_holdout_runs(score) + growth_in_training_runs(diagnosis);
  double worst_K = 0.0;
  for (const calibration::PredictedRun& run : score.runs_after) {
    worst_K = std::max(worst_K, diagnosis::rms_of_run_K(score, run.name, &diagnosis::ErrorInRun::after));
  }
  const double train_K = estimation::rms_K(diagnosis.after_train);
  if (worst_K > kElsewhere_ratio * train_K && worst_K > train_K + 10.0 * estimation::thresholds().matters_K) {
    text += fmt::format(
        " The error in the hold-out runs is up to {:.0f} times that in the training runs: heat acts there that the new file lacks, or "
        "their "
        "units, sampling or sensors differ.",
        worst_K / std::max(estimation::thresholds().matters_K, train_K));
  }
  return text;
}

}  // namespace heatsoak::present
