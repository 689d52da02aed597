// JSON of `log inspect` for one log.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "recording/quality.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak {

/// `recording` holds at least the data that the assessment keeps.
nlohmann::ordered_json log_json(const Recording& recording, const RecordingReport& report, const DataQuality& quality);

}  // namespace heatsoak
