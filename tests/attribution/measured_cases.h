// Measured motors with effects that the recordings do not describe. The recordings are not part of the repository.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/model_file.h"
#include "errors_of_models.h"
#include "scoring.h"

namespace heatsoak::attribution::measured {

/// Folder of the motor files and mappings of the published diagnoses.
const std::filesystem::path& reports();
recording::Recording read(const std::filesystem::path& log, const std::filesystem::path& map);
std::vector<estimation::MeasuredRun> runs_of(const diagnosis::ModelOfLogs& model, const std::vector<recording::Recording>& recordings,
                                             std::optional<double> ambient_C = {});

/// Diagnosis of some recordings and its score on others.
struct Diagnosed {
  diagnosis::ModelOfLogs model;
  diagnosis::DiagnosisInput input;
  diagnosis::Diagnosis diagnosis;
  ErrorsOfModels score;
};
Diagnosed diagnosed(const motor::Motor& motor, const std::vector<recording::Recording>& train,
                    const std::vector<recording::Recording>& holdout, std::optional<double> ambient_C = {});
const diagnosis::FoundEffect* effect_of(const diagnosis::Diagnosis& diagnosis, std::string_view id);

/// Returns the motor with its initial parameter values multiplied by the factors.
motor::Motor guessed_otherwise(motor::Motor motor, const std::map<std::string, double>& factor);

/// Outrunner of a drone on a bench, five runs. In run 4 a fan blew at it that the log does not mention.
struct Drone {
  std::map<std::string, recording::Recording> run;
  motor::Motor motor;  ///< calibrated with runs 1, 3 and 5
};
Drone drone(const std::filesystem::path& folder, bool is_for_forecasts = true, const std::map<std::string, double>& factor = {});
/// Trains with the first part of run 4, among others, and scores its second part.
Diagnosed diagnosed(Drone& all, double cut);

/// Two recordings of the outrunner "Mega" with a propeller on a bench, on two days.
struct PropellerBench {
  recording::Recording january;
  recording::Recording march;
  motor::Motor start;
};
recording::Recording of_bench(const std::filesystem::path& folder, const char* name);
PropellerBench propeller_bench(const std::filesystem::path& folder);

/// Traction motor whose file has copper loss only: trains with the first part of a recording and scores the rest.
Diagnosed of_traction_motor(const std::filesystem::path& folder, double cut);

}  // namespace heatsoak::attribution::measured
