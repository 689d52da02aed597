// Document and JSON of `calibrate`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/calibration_job.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns the document of a calibration. `readings` are the reports of the logs, `out` is the name of the model's file.
Document calibration_document(const motor::Motor& motor, const calibration::CalibrationAnswer& answer,
                              std::span<const recording::LogReading> readings, const std::string& out);
/// Returns the notes: warnings about units and grown errors first, remarks about the logs last.
std::vector<Note> calibration_notes(const calibration::CalibrationAnswer& answer, std::span<const recording::LogReading> readings);
/// Returns the answer as JSON, the data of the document.
Json calibration_json(const motor::Motor& motor, const calibration::CalibrationAnswer& answer,
                      std::span<const recording::LogReading> readings, const std::string& out);

/// Returns the next steps in the order of the work; empty if nothing is open. Steps that the logs require come before the experiment.
std::string next_steps_words(const calibration::CalibrationAnswer& answer);

}  // namespace heatsoak::present
