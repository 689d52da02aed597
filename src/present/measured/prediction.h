// Document and JSON of `predict`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/prediction_job.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns the id of the motor: a model names the motor that it was fitted from, not its own file.
std::string fitted_motor(const motor::Motor& motor);

/// Returns the largest error of the prediction: "the largest error is 1.2 K rms, of the winding in match_3"; empty without a signal.
std::string largest_error_words(const calibration::Prediction& prediction);

/// Returns the document. Warnings about the model's validity come first, and the reader's remarks of `readings` last.
Document prediction_document(const motor::Motor& motor, const calibration::PredictionAnswer& answer,
                             std::span<const recording::LogReading> readings);

/// Returns the answer in the schema heatsoak.prediction/1.
Json prediction_json(const motor::Motor& motor, const calibration::PredictionAnswer& answer,
                     std::span<const recording::LogReading> readings);
/// Returns the notes: warnings about the model's validity in the order of the logs first.
std::vector<Note> prediction_notes(const calibration::PredictionAnswer& answer, std::span<const recording::LogReading> readings);
/// Returns the parameters of the band.
Json band_json(const motor::ForecastBand& band);
/// Returns one JSON object per run, with the keys of heatsoak.prediction/1.
Json runs_json(const std::vector<calibration::PredictedRun>& runs);

}  // namespace heatsoak::present
