#include "motor/sensor_effect.h"

namespace heatsoak::motor::sensors {

SensorEffectType sensor_lag_stator() {
  return {
      .name = {},
      .summary = "The reading at the stator lags, because glue and insulation around the sensor must warm first.",
      .equation = "τ·d shown/dt = T_stator − shown",
      .reference = "first-order response of a temperature probe, ASTM E839",
      .signal = "stator_C",
      .size = {"time_constant", "s", base::Range::between(0.0, 300.0), "time after which the reading shows 63 % of a step"},
      .typical_size = 8.0,
      .typical = "2 to 20 s for a probe glued or taped on",
      .confounded_with =
          "Confounded with connection_resistance of the opposite sign: heat that enters the stator directly with I². Rest and heating by "
          "speed alone separate them.",
      .experiment = "warm the motor by speed alone, without load, then let it rest: a lag delays that too, but there is no I² heat",
      // T rises by 10 K in 10 s, τ = 5 s: behind = 5 K, shown = 30 − 5 + (0 + 5)·e^(−2) = 25.6766764 °C
      .example = {.size = 5.0, .time_s = {0.0, 10.0}, .true_C = {20.0, 30.0}, .sensor_C = {20.0, 25.676676416183064}},
      .law = sensor_lag_law(),
  };
}

}  // namespace heatsoak::motor::sensors
