// The diagnosis in words: verdict, effects with their uncertainty, errors before and after, and the next experiment.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/diagnosis_job.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the diagnosis as a list of sentences. The errors are those of the hold-out runs if `score` has any, else those of the training
/// runs.
std::vector<std::string> diagnosis_words(const Diagnosis& diagnosis, const HoldoutScore& score);

/// Returns the rejected candidates with the reason: "windage: it hardly improves the prediction of whole runs".
std::vector<std::string> refusal_words(const Selection& selection);

/// Returns the reason without the effect: "not every log has speed".
std::string untested_words(const UntestedEffect& untested);

/// Returns the effects that the experiment separates: "iron_loss_eddy or windage".
std::string rivals_of(const Experiment& experiment);
std::string experiment_words(const Experiment& experiment);

struct DiagnosisNote {
  Severity severity = Severity::note;
  std::string words;
};
/// Returns the notes in the order of the JSON: logs, warnings, admission, assumptions. Rejected samples of the logs are background.
std::vector<DiagnosisNote> diagnosis_notes(const DiagnosisAnswer& answer, std::span<const LogReading> readings);

}  // namespace heatsoak::present
