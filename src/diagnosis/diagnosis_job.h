// The answer of `diagnose`: checks the logs, searches the missing effects, scores the hold-out logs, and makes the extended motor.
#pragma once

#include <vector>

#include "calibration/admission.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/findings.h"
#include "diagnosis/model_file.h"
#include "recording/named_logs.h"

namespace heatsoak::diagnosis {

struct DiagnosisJob {
  motor::Motor motor;
  recording::NamedLogs logs;  ///< their choice states whether logs that look wrong are accepted
};

struct DiagnosisAnswer {
  DiagnosisInput input;
  Diagnosis diagnosis;
  HoldoutScore score;
  motor::Motor motor;  ///< the extended motor
  calibration::Admission admission;
  std::vector<DiagnosisFinding> findings;  ///< assumptions and limits of the answer
};

/// Throws Failure as admit(), model_of_logs() and diagnose() do; bad_input if the logs cannot be read as runs; cannot_answer if not even
/// the extended model follows the training logs.
DiagnosisAnswer run_diagnosis(const DiagnosisJob& job, const base::JobProgress& progress = {});

}  // namespace heatsoak::diagnosis
