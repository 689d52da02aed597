#pragma once
// One run of a motor: its simulation, its sensors with their faults, and its log.
#include <filesystem>
#include <string>
#include <vector>

#include "drive.h"
#include "motor.h"
#include "unknown_heat.h"

namespace heatsoak::suite {

/// True temperatures at the places of the sensors, with lag, offset and gain but without noise. One per row.
struct Temperatures {
  double winding_C = 0.0;
  double stator_C = 0.0;
};

struct UnknownHeats {
  std::vector<double> winding_W;
  std::vector<double> stator_W;
};

/// Simulates a run. `start` has one temperature per body; bodies that an effect added begin at the mean of the others and the ambient.
std::vector<Temperatures> simulate(const Motor& motor, const Inputs& inputs, const UnknownHeats& unknown, std::vector<double> start_C);

/// Row of a log. Inputs stand for the second that begins at the row's time, temperatures for the row's time.
struct Row {
  double time_s = 0.0;
  double current_A = 0.0;  ///< RMS with the sign of the mean
  double speed_rad_per_s = 0.0;
  double bus_V = 0.0;
  double modulation_ratio = 0.0;
  double ambient_C = 0.0;
  double winding_C = 0.0;
  double stator_C = 0.0;
  double vehicle_speed_m_per_s = 0.0;
  double fan_ratio = 0.0;
  double neighbour_C = 0.0;
  bool has_winding = true;  ///< false: empty cell
  bool has_stator = true;
  bool winding_is_good = true;  ///< false: outlier or stuck reading
  bool stator_is_good = true;
};
using Log = std::vector<Row>;

/// Noise and resolution of the two temperature sensors of a motor.
struct SensorNoise {
  double winding_K = 0.1;
  double stator_K = 0.1;
  double winding_step_K = 0.1;
  double stator_step_K = 0.1;
};

SensorNoise drawn_noise(Random random);

/// Mean or RMS of the inputs of each second.
Log rows_of(const Inputs& inputs);

/// Fills in what the sensors show, with noise, steps, outliers, stuck readings, empty cells and missing rows.
Log measured(const Log& rows, const std::vector<Temperatures>& truth, const SensorNoise& noise, Random random);

std::string csv_of(const Log& log);

}  // namespace heatsoak::suite
