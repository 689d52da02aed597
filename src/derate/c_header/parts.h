// The parts of the generated C header in the order of the file: one source file each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::c_header {

/// What every part needs.
struct Source {
  const Derating& derating;
  std::string prefix;                     ///< of functions, types and tables
  std::string capital;                    ///< of constants
  std::vector<firmware::Signal> signals;  ///< fields of the input, in the order of firmware::Signal
};

std::string_view name_of(firmware::Signal signal);
/// That a law of the motor depends on; current, speed and air always.
std::vector<firmware::Signal> used_signals(const Observer& observer);

/// What the file is for, what was assumed, how to call it.
std::string head_comment(const Source& source);
/// "#define" lines: period, limits, what the table covers.
std::string constants(const Source& source);
/// Equivalent DC current from i_q; empty for a brushed motor.
std::string foc_conversion(const Source& source);
/// Input, state, reason and output of a step.
std::string structures(const Source& source);
/// The derating table, and in allowed_function() its interpolation.
std::string tables(const Source& source);
std::string allowed_function(const Source& source);
struct Rates {
  std::string text;
  bool calls_thermal_math = false;
};
/// dT/dt of every node, of the guard and of the nominal motor.
Rates rates(const Source& source);
/// Candidate values of the signals that are swept when they are not believed.
std::string candidates(const Source& source);
/// start and step with their helpers.
std::string step_functions(const Source& source);
/// The step with a sensor; empty without one.
Rates sensor_functions(const Source& source);
/// save and restore over power-off. `signature`: of this motor's guard, so that a buffer of another one is refused.
std::string memory_functions(const Source& source, unsigned signature);

}  // namespace heatsoak::c_header
