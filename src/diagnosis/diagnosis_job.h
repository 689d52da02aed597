// The answer of `diagnose`: checks the logs, searches the missing effects, scores the hold-out logs, and makes the extended motor.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibration/admission.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/findings.h"
#include "diagnosis/holdout_score.h"
#include "diagnosis/model_file.h"
#include "recording/named_logs.h"

namespace heatsoak::diagnosis {

struct DiagnosisJob {
  motor::Motor motor;
  recording::NamedLogs logs;  ///< their choice states whether logs that look wrong are accepted
};

/// Size of the 90 % band that the extended motor file has for forecasts.
struct BandSize {
  std::size_t recordings = 0;                  ///< number of recordings that were left out in turn
  std::map<std::string, double> half_width_K;  ///< by signal, mean over the training runs
};

struct DiagnosisAnswer {
  DiagnosisInput input;
  Diagnosis diagnosis;
  HoldoutScore score;
  motor::Motor motor;            ///< the extended motor
  std::optional<BandSize> band;  ///< nothing if the file has no band of its own
  calibration::Admission admission;
  std::vector<DiagnosisFinding> findings;  ///< assumptions and limits of the answer
};

/// Throws Failure as admit(), model_of_logs() and diagnose() do; bad_input if the logs cannot be read as runs; cannot_answer if not even
/// the extended model follows the training logs.
DiagnosisAnswer run_diagnosis(const DiagnosisJob& job, const base::JobProgress& progress = {});

}  // namespace heatsoak::diagnosis
