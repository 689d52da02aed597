#include "motor/sensor_effect.h"

namespace heatsoak::motor::sensors {

SensorEffectType sensor_offset_stator() {
  return {
      .name = {},
      .summary = "The sensor at the stator shows a constant difference to the stator's temperature.",
      .equation = "shown = T_stator + ΔT",
      .reference = "JCGM 100 (GUM), systematic error of an instrument",
      .signal = "stator_C",
      .size = {"offset", "K", base::Range::between(-30.0, 30.0), "reading minus true temperature"},
      .typical_size = 1.0,
      .typical = "0.5 to 2 K for thermistors and thermocouples",
      .confounded_with =
          "Confounded with constant_heat at the stator, almost completely if only the stator is measured. An offset is present from the "
          "first sample.",
      .experiment =
          "let the motor rest for an hour: winding, stator and ambient then have one temperature, and the difference between their "
          "readings is the offset",
      // 21 − 0.5 = 20.5 °C and 60 − 0.5 = 59.5 °C
      .example = {.size = -0.5, .time_s = {0.0, 10.0}, .true_C = {21.0, 60.0}, .sensor_C = {20.5, 59.5}},
      .law = sensor_offset_law(),
  };
}

}  // namespace heatsoak::motor::sensors
