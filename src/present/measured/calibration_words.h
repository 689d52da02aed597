// Wording of the findings of a calibration.
#pragma once

#include <string>
#include <vector>

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the finding as one sentence that starts with its consequence.
std::string words_of(const calibration::CalibrationFinding& finding);
std::string words_of(const calibration::GrownError& error);

/// Warnings are findings after which the values should not be relied on.
Severity severity_of(const calibration::CalibrationFinding& finding);

std::vector<std::string> words_of(const std::vector<calibration::CalibrationFinding>& findings);
std::vector<std::string> words_of(const std::vector<calibration::GrownError>& errors);

/// Returns a sentence with the suspicious value and a question about its likely cause.
std::string words_of(const calibration::LogProblem& problem);
std::vector<std::string> words_of(const std::vector<calibration::AdmissionNote>& notes);
std::vector<std::string> words_of(const std::vector<calibration::PredictionNote>& notes);

Severity severity_of(const calibration::PredictionNote& note);

/// Returns the names of the parameters that are not determined.
std::string parameter_words(const calibration::OpenDirection& open);
/// Returns why they are not determined.
std::string reason_words(const calibration::OpenDirection& open);
std::string_view words_of(calibration::Remedy remedy);

/// Returns what to change before recording more runs.
std::string lag_words(const std::string& temperature);

}  // namespace heatsoak::present
