#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct DriverHeat {
  enum Node { stator };
  enum Parameter { loss, quadratic_share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S current_ratio = named("current_ratio", x.at.current_rms_A / kReferenceCurrent_A);
    const S shape = current_ratio * (1.0 - x.parameter(quadratic_share) + x.parameter(quadratic_share) * current_ratio);
    heat.source(stator, x.parameter(loss) * shape);
  }
};

}  // namespace

EffectType driver_heat() {
  using enum DriverHeat::Parameter;
  return {
      .name = {},
      .summary =
          "Electronics on or near the motor warm it: conduction through diodes and switching loss grow with |I|, the loss in the switches' "
          "resistance with I².",
      .equation = "P_stator = P_5 · ((1 − q)·|I|/(5 A) + q·(I/(5 A))²)",
      .reference = "N. Mohan, T. Undeland, W. Robbins, Power Electronics: conduction and switching loss of semiconductors",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "heat that reaches the node at 5 A"},
                     {"quadratic_share", "", base::Range::between(0.0, 1.0), "share of the heat that grows with I²"}},
      .typical = "0.5 to 2 W at 5 A",
      .confounded_with =
          "Confounded with connection_resistance (I²) at the same node. Constant standby power is constant_heat. A driver with a large "
          "heat capacity of its own responds late; third_node describes that.",
      // 2 W · (0.75 · 2.5/5 + 0.25 · (2.5/5)²) = 2 · (0.375 + 0.0625) = 0.875 W
      .example = {.parameters = {2.0, 0.25}, .at = {.current_rms_A = 2.5}, .temperature_C = {40.0}, .expected_heat_W = {0.875}},
      .laws = laws<DriverHeat>(),
      .needs = {Signal::current},
      .candidacy = {.size_parameter = loss,
                    .variants = {{1.5, 0.0}},
                    .family = "heat with current at the stator",
                    .experiment = "two currents at standstill, then again with the driver moved away or insulated"},
  };
}

}  // namespace heatsoak::thermal::effects
