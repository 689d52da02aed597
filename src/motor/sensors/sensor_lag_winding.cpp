#include "motor/sensor_effect.h"

namespace heatsoak::motor::sensors {

SensorEffectType sensor_lag_winding() {
  return {
      .name = {},
      .summary = "The reading at the winding lags, because glue and insulation around the sensor must warm first.",
      .equation = "τ·d shown/dt = T_winding − shown",
      .reference = "first-order response of a temperature probe, ASTM E839",
      .signal = "winding_C",
      .size = {"time_constant", "s", base::Range::between(0.0, 120.0), "time after which the reading shows 63 % of a step"},
      .typical_size = 4.0,
      .typical = "1 to 5 s for a bead between the wires, more on top of tape",
      .confounded_with =
          "Confounded with a larger heat capacity of the winding, which slows the true temperature as well. A step of current with a fast "
          "log separates them.",
      .experiment = "a step of current at standstill, logged at 10 Hz: a lag rounds off the first seconds, a capacity does not",
      // T rises by 10 K in 10 s, τ = 10 s: behind = 10 K, shown = 30 − 10 + (0 + 10)·e^(−1) = 23.6787944 °C
      .example = {.size = 10.0, .time_s = {0.0, 10.0}, .true_C = {20.0, 30.0}, .sensor_C = {20.0, 23.678794411714423}},
      .law = sensor_lag_law(),
  };
}

}  // namespace heatsoak::motor::sensors
