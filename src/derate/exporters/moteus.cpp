// Configuration for mjbots moteus. Names and law: mjbots/moteus at db1a7623d6a7d5568e7632b974a9ab521a4d2bab,
// fw/bldc_servo_structs.h (BldcServoConfig), fw/bldc_servo_control.h (derate_fraction), lib/python/moteus/moteus_tool.py
// (do_restore_config).
#include <fmt/format.h>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

/// moteus limits i_q and i_d to
///   max(0, max_current_A + f·(derate_current_A − max_current_A)), f = (T − motor_fault_temperature + margin)/margin,
/// at most max_current_A, and stops with a fault above motor_fault_temperature. The same derate_current_A ends the ramp of its switches.
std::string write_moteus(const Derating& derating) {
  require_brushless("moteus", derating);
  const CurrentRamp ramp = ramp_for("moteus", derating, RampSignal::stator);
  return provenance_lines(derating, "#") + ramp_lines(derating, RampSignal::stator, ramp, 1.0 / kDcPerIq_ratio, "#") +
         fmt::format(
             "# Currents are peak phase currents (i_q). Needs a thermistor at the stator on the TEMP pads: set "
             "servo.motor_thermistor_ohm.\n"
             "# Needs firmware with servo.motor_temperature_margin. Write it with: moteus_tool --restore-config FILE ('conf set' for each "
             "line).\n"
             "servo.max_current_A {:.3f}\n"
             "servo.derate_current_A 0\n"
             "servo.enable_motor_temperature 1\n"
             "servo.motor_temperature_margin {:.0f}\n"
             "servo.motor_fault_temperature {:.0f}\n"
             "servo.fw.enable 0\n",
             rounded_down_A(ramp.most_current_A / kDcPerIq_ratio), ramp.end_C - ramp.start_C, ramp.end_C);
}

}  // namespace

ExporterType moteus() {
  return {.name = {},
          .summary = "moteus configuration: current and ramp over a stator thermistor, fitted on the safe side",
          .write = write_moteus};
}

}  // namespace heatsoak::derate::exporters
