// The picture of `log inspect`: every channel over time, with what was left out.
#pragma once

#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"
#include "report/chart.h"

namespace heatsoak {

Chart log_chart(const Recording& recording, const RecordingReport& report);

}  // namespace heatsoak
