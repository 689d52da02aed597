// Document and JSON of `calibrate`.
#pragma once

#include <string>
#include <vector>

#include "calibration/calibrate.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Remarks on the logs, from before the fit.
struct LogRemarks {
  std::vector<std::string> of_reading;    ///< rejected samples
  std::vector<std::string> of_screening;  ///< properties that look wrong but may be right
};
Document calibration_document(const Motor& motor, const Calibration& result, const LogRemarks& remarks);
/// `out` is the name of the model's file.
Json calibration_json(const Motor& motor, const Calibration& result, const LogRemarks& remarks, const std::string& out);

/// Returns all remarks and findings as sentences, for the JSON.
std::vector<std::string> all_notes(const Calibration& result, const LogRemarks& remarks);

}  // namespace heatsoak::present
