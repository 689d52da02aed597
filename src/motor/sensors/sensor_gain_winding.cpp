#include "motor/sensor_effect.h"

namespace heatsoak::motor::sensors {

SensorEffectType sensor_gain_winding() {
  return {
      .name = {},
      .summary = "Gain error: the sensor at the winding scales every temperature rise above 25 °C by a constant factor.",
      .equation = "shown = T_winding + ε·(T_winding − 25 °C)",
      .reference = "JCGM 100 (GUM), systematic error of an instrument; wrong beta of a thermistor",
      .signal = "winding_C",
      .size = {"relative_error", "", base::Range::between(-0.5, 0.5), "relative error of the rise above 25 °C"},
      .typical_size = 0.03,
      .typical = "0.01 to 0.05 for a thermistor with a nominal beta",
      .confounded_with =
          "Confounded with a different thermal resistance between winding and stator. Heat from speed alone separates them: then only the "
          "gain shows.",
      .experiment = "warm the motor by speed alone: winding and stator then differ by little, and a gain error shows",
      // 25 + 1.1·(75 − 25) = 80 °C; 25 °C is unchanged
      .example = {.size = 0.1, .time_s = {0.0, 10.0}, .true_C = {25.0, 75.0}, .sensor_C = {25.0, 80.0}},
      .law = sensor_gain_law(),
  };
}

}  // namespace heatsoak::motor::sensors
