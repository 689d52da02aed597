// Converts a motor file to a model of measured runs, and a diagnosis back to a motor file.
#pragma once

#include <string>
#include <vector>

#include "calibration/motor_model.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/findings.h"
#include "motor/motor.h"

namespace heatsoak::diagnosis {

/// A motor's model as the logs require it.
struct ModelOfLogs {
  estimation::Model model;
  calibration::HeatInput heat = calibration::HeatInput::current;
  attribution::UsualErrors usual;
  std::vector<calibration::CalibratedValue> parameters;  ///< parameters of the motor file, as functions of the model's coordinates
  estimation::MeasuredRunOptions how;      ///< required signals and options for reading the runs, except for the ambient temperature
  std::vector<std::string> fitted;         ///< logs that the file's parameters were fitted to, as name_and_fingerprint()
  motor::TrainingRange training;           ///< range of the signals in those logs and in these
  bool is_speed_linear = false;            ///< in rows in which the motor may reverse (turning_rows.h)
  std::vector<DiagnosisFinding> findings;  ///< assumptions for signals that no log has
};

/// Builds the motor's network with the same free parameters as a calibration and with the file's uncertainties as priors. The heat input is
/// that of heat_input_of(). If the file states none, recordings with and without a current are refused by measured_runs(). Effects with a
/// condition act in the runs that have it. Heat inputs that no recording has are 0. Throws Failure (bad_input) if the recordings have no
/// heat input that an effect of the motor uses.
ModelOfLogs model_of_logs(const motor::Motor& motor, const std::vector<recording::Recording>& recordings);

/// Returns the motor with the parameters, effects and sensor errors of the diagnosis; to_toml() writes it as a motor file. Run deviations
/// are not properties of a motor and are left out.
motor::Motor extended_motor(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis);

/// Returns the motor with only its own parameters refitted to the training runs: the part of the gain that is due to no effect.
motor::Motor refitted_motor(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis);

/// Returns the fitted parameters whose value in `after` is outside the range (`spread`) that the file `before` declares. The interval of a
/// measured value is the result of an earlier fit and no declared range.
std::vector<calibration::OutsideDeclaredRange> outside_declared_ranges(const motor::Motor& before, const ModelOfLogs& model,
                                                                       const motor::Motor& after);

}  // namespace heatsoak::diagnosis
