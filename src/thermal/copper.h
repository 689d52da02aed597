// How the resistance of copper rises with its temperature; the only place.
#pragma once

namespace heatsoak {

/// Data sheets give resistance and torque constant at this temperature, and α refers to it.
inline constexpr double kSheetTemperature_C = 25.0;
inline constexpr double kCopper_per_K = 0.0039;  ///< α where nothing else is stated

/// R(T)/R25 = 1 + α·(T − 25 °C); copper's α is 0.0039 1/K. For numbers, lanes and derivatives.
template <class S>
S resistance_ratio(const S& coefficient_per_K, const S& temperature_C) {
  return 1.0 + coefficient_per_K * (temperature_C - kSheetTemperature_C);
}

}  // namespace heatsoak
