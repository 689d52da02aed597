// One motor under the prescribed load of a wheel, nominal: evaluation and trace.
#pragma once

#include <cstdint>
#include <optional>

#include "select/evaluate.h"
#include "select/trace.h"

namespace heatsoak::select {

struct LoadJob {
  robot::Robot robot;
  motor::Motor motor;
  duty::Duty duty;           ///< not a match
  std::uint64_t seed = 1;    ///< seed of the duty's demand
  double every_s = 1.0;      ///< longest time between two rows of the trace
  bool with_curves = false;  ///< keep the temperatures over time in `result`
};

/// Peak temperatures with motor::at_upper_band().
struct UpperPeaks {
  double winding_C = 0.0;
  double stator_C = 0.0;
};

struct LoadSimulation {
  robot::Robot robot;
  motor::Motor motor;
  duty::Duty duty;
  double duration_s = 0.0;
  MotorEvaluation result;                ///< evaluation of the wheel whose winding gets hottest; marginal if it fails only in `upper`
  std::optional<UpperPeaks> upper = {};  ///< empty without a forecast band
  Trace trace;                           ///< trace of the same wheel
};

/// Throws Failure (bad_input) if the trace would have more rows than memory allows.
LoadSimulation simulate_load(const LoadJob& job);

}  // namespace heatsoak::select
