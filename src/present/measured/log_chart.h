// Chart of `log inspect`: every channel over time, with rejected samples marked.
#pragma once

#include "recording/inspect_log.h"
#include "report/chart.h"

namespace heatsoak::present {

report::Chart log_chart(const recording::InspectedLog& log);

}  // namespace heatsoak::present
