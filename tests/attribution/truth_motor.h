// Synthetic motor for examinations with eight parts, its own equations and its own integrator. It shares no code with the tool's network. A
// missing effect adds heat to its parts.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "recording/recording.h"

namespace heatsoak::attribution::truth {

/// Copper in the slots and at both ends, iron, sleeve and two end shields, and two lumps that only some effects use.
enum Part { slot, overhang_front, overhang_back, tooth, yoke, sleeve, shield_front, shield_back, lump_a, lump_b, part_count };
using PerPart = std::array<double, part_count>;

/// Inputs that are constant over one row of the log.
struct RowInputs {
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  double next_acceleration_rad_per_s2 = 0.0;  ///< acceleration in the second that starts with this row
  double ambient_C = 25.0;
  double bus_V = 24.0;
  double duty_ratio = 0.0;
  double vehicle_speed_m_per_s = 0.0;
  double neighbour_C = 25.0;
};

struct Moment {
  const RowInputs& in;
  const PerPart& part_C;
  double copper_loss_W;     ///< loss of all copper at its present temperature
  double time_s;            ///< time since the start of the run
  double age_h;             ///< running time of all runs together
  double copper_C, iron_C;  ///< means weighted by heat capacity
};

/// Adds the effect's heat flow into each part; positive values heat it.
using Heat = std::function<void(const Moment&, PerPart& heat_W)>;

/// Returns a sensor's reading from the true temperatures and the last reading; called once per second.
struct SensorFault {
  double winding_offset_K = 0.0, stator_offset_K = 0.0;
  double winding_lag_s = 0.0, stator_lag_s = 0.0;
  double winding_gain_ratio = 1.0;
};

struct Missing {
  std::vector<Heat> heat;
  SensorFault sensors;
  PerPart lump_capacity_J_per_K{};  ///< capacities of lump_a and lump_b; 0 disables a lump
};

struct MotorMake {
  double copper_capacity_J_per_K = 18.0;
  double iron_capacity_J_per_K = 95.0;
  double copper_to_iron_K_per_W = 1.6;
  double iron_to_air_K_per_W = 5.5;
  double resistance_25C_ohm = 0.45;
  double copper_per_K = 0.0039;
  /// Factor of the conductances between parts of one material. Below 0.1 two nodes no longer approximate the motor.
  double metal_ratio = 1.0;
  int finer = 1;  ///< divides the step size that the fastest part requires
};

struct Surprise {
  double flux_W = 0.06;  ///< RMS of an unknown slow heat flow, into copper and into iron each
  double flux_time_s = 180.0;
  double noise_K = 0.15;
  double step_K = 0.1;  ///< resolution of the converter
  double outlier_probability = 0.003;
  double gap_probability = 0.0008;  ///< probability per row that a gap of about 30 s starts
  double drift_K = 0.0;             ///< RMS of a slow random error of each sensor
  double drift_time_s = 300.0;
};

/// True temperatures at the sensors' places, beside the log.
struct TrueRun {
  recording::Recording log;
  std::vector<double> winding_C, stator_C;
};

/// Simulates the motor over rows of one second. `age_h` is the running time before the first row.
TrueRun run_motor(const MotorMake& make, const Missing& missing, const Surprise& surprise, const std::vector<RowInputs>& rows, double age_h,
                  std::uint64_t seed, const std::string& name);

/// Random numbers that are identical on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15U + 0x2545f4914f6cdd1dU) { engine_.discard(16); }
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
  double normal();
  int below(int count) { return static_cast<int>(uniform(0.0, count)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace heatsoak::attribution::truth
