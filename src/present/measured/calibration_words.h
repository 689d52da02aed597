// Wording of the findings of a calibration.
#pragma once

#include <string>
#include <vector>

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

}  // namespace heatsoak::present
