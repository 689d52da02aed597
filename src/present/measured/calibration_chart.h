// Chart of a calibration: measured temperatures, and the free-running model before and after the fit.
#pragma once

#include "calibration/calibrate.h"
#include "report/chart.h"

namespace heatsoak::present {

report::Chart calibration_chart(const motor::Motor& motor, const calibration::Calibration& calibration);

}  // namespace heatsoak::present
