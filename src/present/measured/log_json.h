// JSON of `log`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "present/json.h"
#include "recording/quality.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::present {

/// Returns the JSON of one log. `recording` holds at least the data that the assessment keeps.
Json log_json(const recording::Recording& recording, const recording::RecordingReport& report, const recording::DataQuality& quality);

/// Returns the answer of `log inspect`; `logs` are results of log_json().
Json logs_json(const std::vector<Json>& logs);

/// Returns the answer of `log convert`.
Json conversion_json(const std::filesystem::path& file, const std::string& out, const recording::Recording& recording,
                     const recording::RecordingReport& report);

}  // namespace heatsoak::present
