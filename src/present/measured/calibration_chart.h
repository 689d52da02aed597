// Chart of a calibration: measured temperatures, and the free-running model before and after the fit.
#pragma once

#include "calibration/calibrate.h"
#include "report/chart.h"

namespace heatsoak::present {

Chart calibration_chart(const Motor& motor, const Calibration& calibration);

}  // namespace heatsoak::present
