// Stage between the supply and the thermal network: limits the wanted current to the available voltage and computes its copper loss.
#pragma once

#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/copper.h"
#include "thermal/operating_point.h"
#include "thermal/scalar.h"

namespace heatsoak::thermal {

/// Reads terminal resistance and temperature coefficient in the network's list of parameters and the temperature of the winding. The
/// voltage that is left after the back-EMF drives the current through R25·(1 + α·(T − 25 °C)) plus the resistance in series.
class DriveStage {
 public:
  /// Places of R25 in ohm and α in 1/K in the list of parameters, and of the winding among the nodes.
  struct Places {
    int resistance = 0;
    int coefficient = 0;
    int winding = 0;
  };

  explicit DriveStage(const Places& places) : places_(places) {}

  [[nodiscard]] const Places& places() const { return places_; }

  /// Returns I²·R25·(1 + α·(T − 25 °C)) in W.
  template <class S>
  static S copper_loss_W(const S& current_A, const S& resistance_25C_ohm, const S& coefficient_per_K, const S& winding_C) {
    const S resistance_ohm = named("winding_resistance_ohm", resistance_25C_ohm * base::resistance_ratio(coefficient_per_K, winding_C));
    return named("heating_current_squared_A2", current_A * current_A) * resistance_ohm;
  }
  template <class S>
  [[nodiscard]] S copper_loss_W(const S& current_A, const S* parameters, const S* temperature_C) const {
    return copper_loss_W(current_A, parameters[places_.resistance], parameters[places_.coefficient], temperature_C[places_.winding]);
  }

  /// Returns the part of the operating point's current in A that its headroom allows at these temperatures. S is double or Lanes.
  template <class S>
  [[nodiscard]] S current_A(const OperatingPoint<S>& at, const S* parameters, const S* temperature_C) const {
    const S hot_ratio = base::resistance_ratio(parameters[places_.coefficient], temperature_C[places_.winding]);
    const S loop_ohm = parameters[places_.resistance] * hot_ratio + at.series_resistance_ohm;
    // A solver may try temperatures at which the linear resistance is negative; an infinite headroom must not give -inf A there.
    constexpr double kLeast_ohm = std::numeric_limits<double>::min();
    if constexpr (std::is_same_v<S, double>) {
      return std::min(at.current_rms_A, at.resistive_headroom_V / std::max(loop_ohm, kLeast_ohm));
    } else {
      return at.current_rms_A.min(at.resistive_headroom_V / loop_ohm.max(kLeast_ohm));
    }
  }

 private:
  Places places_;
};

}  // namespace heatsoak::thermal
