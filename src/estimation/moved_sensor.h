// A sensor that reads another place in one recording than in the others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/model.h"

namespace heatsoak::estimation {

/// Reading of a moved sensor: T + to_other·(T_other − T) + to_ambient·(T_ambient − T) + offset, where T is the temperature of its node.
struct MovedSensor {
  std::string signal;
  double to_other_share = 0.0;    ///< towards the place of the other sensor; 0 with one sensor
  double to_ambient_share = 0.0;  ///< towards the ambient air
  double offset_K = 0.0;
  double rmse_K = 0.0;  ///< RMS error of the readings of all sensors of the recording, with equal weights
};

/// Returns the sensor whose move explains the readings best. `parts`: the runs of one recording. The parameters of the model are held, the
/// start temperatures of each part are fitted with the move by Gauss-Newton steps. Empty if a simulation fails.
std::optional<MovedSensor> moved_sensor(const Model& model, const std::vector<MeasuredRun>& parts);

}  // namespace heatsoak::estimation
