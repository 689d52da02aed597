// Temperature dependence of the resistance of copper. No other file computes it.
#pragma once

namespace heatsoak::base {

/// Reference temperature of resistance, torque constant and α on data sheets.
inline constexpr double kSheetTemperature_C = 25.0;
inline constexpr double kCopper_per_K = 0.0039;  ///< default for α of copper

/// Returns R(T)/R25 = 1 + α·(T − 25 °C). S is a number, Lanes or a type with derivatives.
template <class S>
S resistance_ratio(const S& coefficient_per_K, const S& temperature_C) {
  return 1.0 + coefficient_per_K * (temperature_C - kSheetTemperature_C);
}

}  // namespace heatsoak::base
