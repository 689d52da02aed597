// Between a motor file and a model of measured runs: what is fitted of it, and how what was found goes back into the file.
#pragma once

#include <string>
#include <vector>

#include "attribution/diagnosis.h"
#include "calibration/motor_model.h"
#include "motor/motor.h"

namespace heatsoak {

struct ModelOfLogs {
  ExtendedModel model;
  std::vector<CalibratedValue> figures;  ///< of the motor's file, as the model's parameters make them
  MeasuredRunOptions how;                ///< what its runs must have and how they are read; but for the ambient temperature
  std::vector<std::string> fitted;       ///< rows that the figures know, as name_and_fingerprint()
  TrainingRange training;                ///< of the runs that they are rows of
  std::vector<std::string> notes;        ///< what is taken for granted because no log has it
};

/// The motor's network with the figures free that a calibration frees, known before as well as the file says. Where not every recording has
/// a current, measured input power heats the winding. Effects under conditions act in the runs that have them. Heat inputs that no
/// recording has count as 0. Throws Failure (bad_input) where the recordings have no heat input that the motor's effects turn into heat.
ModelOfLogs model_of_logs(const Motor& motor, const std::vector<Recording>& recordings);

/// The motor with the diagnosis' figures and its effects, those of sensors too: what `to_toml` writes is again a motor file. Deviations of
/// a run's heat are no properties of a motor: they become notes.
Motor extended_motor(const Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis);

/// The score of two motor files on recordings that decided nothing, by predict(): replaces errors before and after in `score`, per signal
/// those of the run that it is worst in after the diagnosis.
void score_files(const Motor& before, const Motor& after, const std::vector<Recording>& holdout, const PredictionOptions& options,
                 HoldoutScore& score);

}  // namespace heatsoak
