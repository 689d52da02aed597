// The diagnosis in words: verdict, effects with their uncertainty, errors before and after, and the next experiment.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/diagnosis_job.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the verdict as a clause: "the model lacks windage".
std::string verdict_words(const diagnosis::Diagnosis& diagnosis);

/// Returns the diagnosis as a list of sentences. The errors are those of the hold-out runs if there are any, else those of the training
/// runs.
std::vector<std::string> diagnosis_words(const diagnosis::DiagnosisAnswer& answer);

/// Returns one sentence per unexplained heat. Curves with the same node, factor and signals share one.
std::vector<std::string> unexplained_words(const diagnosis::Diagnosis& diagnosis);

/// Returns the rejected candidates with the reason: "windage: it hardly improves the prediction of whole runs".
std::vector<std::string> refusal_words(const attribution::Selection& selection);

/// Returns the reason without the effect: "not every log has speed".
std::string untested_words(const attribution::UntestedEffect& untested);

/// Returns the effects that the experiment separates: "iron_loss_eddy or windage".
std::string rivals_of(const diagnosis::Experiment& experiment);
std::string experiment_words(const diagnosis::Experiment& experiment);

/// Returns the notes of the extended motor's file: run deviations, which are not properties of the motor.
std::vector<std::string> notes_of_model_file(const diagnosis::Diagnosis& diagnosis);

/// Returns the finding as one sentence.
std::string words_of(const diagnosis::DiagnosisFinding& finding);
/// Warnings are findings after which a named effect may be wrong, or a missing one may stay unfound.
Severity severity_of(const diagnosis::DiagnosisFinding& finding);

/// Returns the notes in the order of the JSON: logs, warnings, admission, assumptions. Rejected samples of the logs are background.
std::vector<Note> diagnosis_notes(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings);

}  // namespace heatsoak::present
