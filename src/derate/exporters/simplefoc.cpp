// Arduino code for SimpleFOC beside the C header. Names: simplefoc/Arduino-FOC at 7f9c45fa3af42eec993b807b97dc544f50975e73,
// src/common/base_classes/FOCMotor.h (current, shaft_velocity, torque_controller), FOCMotor.cpp (updateCurrentLimit, loopFOC). That commit
// is v2.4.0, the first version with updateCurrentLimit; the library has no version macro.
#include <fmt/format.h>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_simplefoc(const Derating& derating) {
  require_finite(derating);
  require_brushless("simplefoc", derating);
  require_three_signals("simplefoc", derating);
  return provenance_lines(derating, "//") +
         fmt::format(
             "// Limits the current of a SimpleFOC motor with the C header of the same inputs (derate --to c_header --out {0}_guard.h). "
             "It\n"
             "// allows the full current of the table. Needs SimpleFOC 2.4.0 or later. Call it every {1:.6g} s with a current sense "
             "linked, "
             "in the\n"
             "// torque mode foc_current or dc_current. The modes voltage and estimated_current measure no current, even with a current "
             "sense:\n"
             "// the function then disables the motor. feed_forward_current is added after the limit: leave it at 0.\n"
             "#pragma once\n"
             "\n"
             "#include <SimpleFOC.h>\n"
             "#include \"{0}_guard.h\"\n"
             "\n"
             "template <typename Motor>\n"
             "constexpr auto {0}_has_limit(Motor *motor) -> decltype(motor->updateCurrentLimit(0.0f), true) {{\n"
             "  return true;\n"
             "}}\n"
             "constexpr bool {0}_has_limit(...) {{ return false; }}\n"
             "static_assert({0}_has_limit(static_cast<FOCMotor *>(nullptr)), \"the guard of {0} needs SimpleFOC 2.4.0 or later\");\n"
             "\n"
             "// ambient_C: air around the motor; {2:.6g} if it is not measured. Returns the guard's output, for logs.\n"
             "inline {0}_output {0}_limit(FOCMotor &motor, {0}_state &state, float ambient_C) {{\n"
             "  const bool is_measured = motor.current_sense != nullptr && (motor.torque_controller == TorqueControlType::foc_current ||\n"
             "                                                              motor.torque_controller == TorqueControlType::dc_current);\n"
             "  const float iq_A = motor.current.q, id_A = motor.current.d;\n"
             "  const float magnitude_A = sqrtf(iq_A * iq_A + id_A * id_A);\n"
             "  const {0}_input input = {{{0}_current_from_iq_A(iq_A < 0.0f ? -magnitude_A : magnitude_A), motor.shaft_velocity, "
             "ambient_C}};\n"
             "  const {0}_output output = {0}_step(&state, &input);\n"
             "  if (!is_measured) {{\n"
             "    motor.disable();\n"
             "  }}\n"
             "  motor.updateCurrentLimit(is_measured ? {0}_iq_limit_A(output.allowed_current_A) : 0.0f);\n"
             "  return output;\n"
             "}}\n"
             "\n"
             "// static {0}_state guard;                                 // not started: taken as hot as its limit\n"
             "// void setup() {{ ... {0}_start(&guard, board_C); }}       // after a long rest\n"
             "// void loop() {{ motor.loopFOC(); motor.move(); if (every {1:.6g} s) {0}_limit(motor, guard, {2:.1f}f); }}\n",
             identifier(derating.motor_id), derating.options.period_s, derating.rules.hottest_ambient_C);
}

}  // namespace

ExporterType simplefoc() {
  return {.name = {},
          .summary = "Arduino code that limits a SimpleFOC motor with the C header of the same motor",
          .usual_ending = ".h",
          .write = write_simplefoc};
}

}  // namespace heatsoak::derate::exporters
