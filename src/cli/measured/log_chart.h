// Chart of `log inspect`: every channel over time, with rejected samples marked.
#pragma once

#include "identify/measurement/condensed_recording.h"
#include "identify/measurement/quality.h"
#include "identify/measurement/recording_report.h"
#include "report/chart.h"

namespace heatsoak {

Chart log_chart(const CondensedRecording& condensed, const DataQuality& quality, const RecordingReport& report);

}  // namespace heatsoak
