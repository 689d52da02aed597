// Estimates the delay between heat input and temperature, which is a clock offset or a sensor lag.
#pragma once

#include <optional>

#include "recording/findings.h"
#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Returns the delay for which a linear regression explains the changes of `temperature` best. The regressors are the delayed heat input
/// and the mean temperatures in each window; no motor model is needed. `noise_K` is the standard deviation of the temperature's noise.
ClockOffset clock_offset(const Recording& recording, const Channel& temperature, const Channel& heat_input, double noise_K);

/// Returns a finding if the winding certainly responds before its heat input. `period_s` is the row spacing.
std::optional<RespondsEarly> early_answer(const ClockOffset& offset, double period_s);
/// Returns a finding if the winding certainly responds late.
std::optional<RespondsLate> late_answer(const ClockOffset& offset, double period_s);

}  // namespace heatsoak::recording
