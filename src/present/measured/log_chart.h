// Chart of `log inspect`: every channel over time, with rejected samples marked.
#pragma once

#include "recording/condensed_recording.h"
#include "recording/quality.h"
#include "recording/recording_report.h"
#include "report/chart.h"

namespace heatsoak::present {

Chart log_chart(const CondensedRecording& condensed, const DataQuality& quality, const RecordingReport& report);

}  // namespace heatsoak::present
