// Chart of `log inspect`: every channel over time, with rejected samples marked.
#pragma once

#include "recording/condensed_recording.h"
#include "recording/quality.h"
#include "recording/recording_report.h"
#include "report/chart.h"

namespace heatsoak::present {

report::Chart log_chart(const recording::CondensedRecording& condensed, const recording::DataQuality& quality,
                        const recording::RecordingReport& report);

}  // namespace heatsoak::present
