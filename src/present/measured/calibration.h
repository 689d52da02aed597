// Document and JSON of `calibrate`.
#pragma once

#include <span>
#include <string>

#include "calibration/calibration_job.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// `readings` are the reports of the logs.
Document calibration_document(const Motor& motor, const CalibrationAnswer& answer, std::span<const LogReading> readings);
/// `out` is the name of the model's file.
Json calibration_json(const Motor& motor, const CalibrationAnswer& answer, std::span<const LogReading> readings, const std::string& out);

/// Returns the next steps in the order of the work; empty if nothing is open. Steps that the logs require come before the experiment.
std::string next_steps_words(const CalibrationAnswer& answer);

}  // namespace heatsoak::present
