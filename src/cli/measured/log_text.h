// Output of `log inspect` for one log, as text and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "recording/quality.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak {

/// `recording` holds at least the data that the assessment keeps.
std::string log_text(const Recording& recording, const RecordingReport& report, const DataQuality& quality);
nlohmann::ordered_json log_json(const Recording& recording, const RecordingReport& report, const DataQuality& quality);

/// Returns the rejected samples, one sentence per channel and reason: "798 samples of winding_C: saturated; line 12-14, 20".
std::vector<std::string> left_out_sentences(const RecordingReport& report);

}  // namespace heatsoak
