// Band of the forecasts with an extended motor file, from predictions of each recording by a fit to the others.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/diagnosis.h"
#include "diagnosis/model_file.h"
#include "recording/recording.h"

namespace heatsoak::diagnosis {

/// Refits the effects that were found, without each recording in turn, and fits the band to the errors of the predicted recordings.
/// `recordings` are those of the training runs. Returns nothing for a single recording, and if a fit without one fails.
std::optional<motor::ForecastBand> left_out_band(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis,
                                                 const std::vector<recording::Recording>& recordings);

}  // namespace heatsoak::diagnosis
