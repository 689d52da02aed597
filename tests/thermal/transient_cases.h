// Two-node motors for every method of integration.
#pragma once

#include <gtest/gtest.h>

#include "thermal/transient.h"
#include "two_node.h"

namespace heatsoak::thermal {

inline constexpr TwoNode kMotor{.resistance_25C_ohm = 0.9,
                                .temperature_coefficient_per_K = 0.0039,
                                .drag_torque_Nm = 0.008,
                                .winding_stator_K_per_W = 3.8,
                                .stator_ambient_K_per_W = 2.8,
                                .winding_J_per_K = 3.2,
                                .stator_J_per_K = 28.0};

inline TransientResult run(const TwoNode& motor, std::span<const Interval> intervals, const TransientOptions& options = {},
                           const TransientObserver& observer = {}) {
  const Network network = motor.network();
  return run_transient(network, network.values(), intervals, options, observer);
}

inline std::vector<Interval> random_duty(Chance& chance, const TwoNode& motor, int pieces) {
  std::vector<Interval> intervals;
  const double ambient_C = chance.between(0.0, 40.0);
  for (int i = 0; i < pieces; ++i) {
    intervals.push_back({chance.by_ratio(0.05, 50.0), chance.point(motor)});
    intervals.back().at.ambient_C = ambient_C;
  }
  return intervals;
}

class EveryMethod : public testing::TestWithParam<ode::OdeMethod> {
 protected:
  static TransientOptions tight(double tolerance) {
    TransientOptions options;
    options.method = GetParam();
    options.tolerances = {tolerance, tolerance};
    return options;
  }
};

}  // namespace heatsoak::thermal
