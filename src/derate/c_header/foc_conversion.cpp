#include <fmt/format.h>

#include <numbers>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/export_text.h"

namespace heatsoak::derate::c_header {

std::string foc_conversion(const Source& source) {
  const Derating& derating = source.derating;
  if (!derating.is_brushless) {
    return {};
  }
  const double counted_ratio = kDcPerIq_ratio * derating.heating_current_ratio / (0.5 * std::numbers::sqrt3);
  const double excess_percent = 100.0 * (counted_ratio * counted_ratio - 1.0);
  return fmt::format(
      "/* From field-oriented control (FOC): i_q in A, amplitude-invariant, that is the peak of a phase current. The current that this\n"
      " * header expects and allows is the equivalent DC current I = torque / TORQUE_CONSTANT of block commutation, with the copper loss\n"
      " * I^2 * R, R between two terminals, 2 * R_phase. With a sinusoidal back-EMF of amplitude E * w per phase\n"
      " *   TORQUE_CONSTANT = 3 * sqrt(3) / pi * E   and   torque = 3/2 * E * i_q,   so   I = sqrt(3) * pi / 6 * i_q = 0.907 * i_q.\n"
      " * The motor's copper loss is 3/2 * i_q^2 * R_phase = (sqrt(3) / 2 * i_q)^2 * R, that of 0.866 * i_q. The heat laws use\n"
      " * {:.3f} * i_q, because the robot's file states {} commutation: {}.\n"
      " * Sign: i_q > 0 has the sign of a speed > 0, so that both have the same sign when the motor drives. Give the rms over the period.\n"
      " * With i_d use sqrt(i_d^2 + i_q^2) with the sign of i_q. Power-invariant i_q: multiply it by sqrt(2/3) first. */\n"
      "#define {}_DC_A_PER_IQ_A {}\n"
      "static inline float {}_current_from_iq_A(float iq_A) {{ return {}_DC_A_PER_IQ_A * iq_A; }}\n"
      "/* magnitude of i_q that corresponds to allowed_current_A */\n"
      "static inline float {}_iq_limit_A(float allowed_current_A) {{\n"
      "  return allowed_current_A / {}_DC_A_PER_IQ_A;\n"
      "}}\n"
      "\n",
      kDcPerIq_ratio * derating.heating_current_ratio, derating.heating_current_ratio < 1.0 ? "sinusoidal" : "block",
      excess_percent < 0.5 ? "torque and copper loss are both exact"
                           : fmt::format("torque is exact, copper loss {:.1f} % too high, which is on the safe side", excess_percent),
      source.capital, literal(kDcPerIq_ratio), source.prefix, source.capital, source.prefix, source.capital);
}

}  // namespace heatsoak::derate::c_header
