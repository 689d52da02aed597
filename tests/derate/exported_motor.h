// A derating with all data that exporters write, and its exports.
#pragma once

#include <stdexcept>
#include <string>

#include "derate/derating_job.h"
#include "derate/exporter.h"
#include "guarded_motor.h"

namespace heatsoak::derate {

/// The paper's motor, derated by the call of `derate`.
inline const Derating& ecx_derating() {
  static const Derating derating = run_derating({.robot = twente(), .motor = ecx_32(), .options = {}}).derating;
  return derating;
}

/// Derates another motor without a search, with a given safety factor.
inline Derating derating_of(const motor::Motor& motor) {
  const GuardedMotor guarded(motor, rules_for(motor), 1.5);
  Derating derating = ecx_derating();
  derating.observer = guarded.observer;
  derating.rules = guarded.rules;
  derating.table = guarded.table;
  derating.reachable_speed_rad_per_s = guarded.rules.most_speed_rad_per_s;
  derating.effects = acting_effects(guarded.network, motor);
  return derating;
}

inline std::string exported(std::string_view name, const Derating& derating = ecx_derating()) {
  for (const ExporterType& each : all_exporters()) {
    if (each.name == name) {
      return each.write(derating);
    }
  }
  ADD_FAILURE() << "no exporter " << name;
  return {};
}

/// The same with a binary for this machine.
inline std::string compiled(const std::string& form, const Derating& derating = ecx_derating()) {
  for (const ExporterType& each : all_exporters()) {
    if (each.name == form) {
      return each.write_compiled(derating, "cc");
    }
  }
  throw std::out_of_range(form);
}

}  // namespace heatsoak::derate
