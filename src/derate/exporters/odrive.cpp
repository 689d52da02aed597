// Commands for odrivetool, firmware 0.5.2 to 0.5.6 (0.5.1 has another place for the thermistor). Names and law: odriverobotics/ODrive at
// f9b5419c820c6fb2f609322a5131cdf8c5f71657, Firmware/odrive-interface.yaml, Firmware/MotorControl/thermistor.cpp (get_current_limit,
// do_checks), motor.cpp (effective_current_lim).
#include <fmt/format.h>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

/// ODrive limits the current vector to current_lim·(upper − T)/(upper − lower), from 0 to current_lim, and disarms with an error 5 K above
/// the upper limit. A temperature that is not a number gives 0 A.
std::string write_odrive(const Derating& derating) {
  require_brushless("odrive", derating);
  const CurrentRamp ramp = ramp_for("odrive", derating, RampSignal::stator);
  return provenance_lines(derating, "#") + ramp_lines(derating, RampSignal::stator, ramp, 1.0 / kDcPerIq_ratio, "#") +
         fmt::format(
             "# Currents are peak phase currents (i_q). Needs a thermistor at the stator: set its gpio_pin and\n"
             "# set_motor_thermistor_coeffs(axis, Rload, R_25, Beta, Tmin, Tmax) first. For odrivetool, firmware 0.5.2 to 0.5.6.\n"
             "# The current comes last, so that a firmware without these settings changes nothing.\n"
             "axis = odrv0.axis0\n"
             "axis.motor.motor_thermistor.config.temp_limit_lower = {:.0f}\n"
             "axis.motor.motor_thermistor.config.temp_limit_upper = {:.0f}\n"
             "axis.motor.motor_thermistor.config.enabled = True\n"
             "axis.motor.config.current_lim = {:.3f}\n"
             "odrv0.save_configuration()\n",
             ramp.start_C, ramp.end_C, rounded_down_A(ramp.most_current_A / kDcPerIq_ratio));
}

}  // namespace

ExporterType odrive() {
  return {.name = {},
          .summary = "ODrive 0.5.2 to 0.5.6 commands for odrivetool: current and ramp over a stator thermistor, fitted on the safe side",
          .write = write_odrive};
}

}  // namespace heatsoak::derate::exporters
