// Generators for the parts of the C header, in the order of the file. Each part has its own source file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate::c_header {

/// Inputs of every part.
struct Source {
  const Derating& derating;
  std::string prefix;                     ///< prefix of functions, types and tables
  std::string capital;                    ///< prefix of constants
  std::vector<observed::Signal> signals;  ///< fields of the input, in the order of observed::Signal
};

std::string_view name_of(observed::Signal signal);
/// Returns the signals that a law of the motor depends on; always current, speed and air.
std::vector<observed::Signal> used_signals(const Observer& observer);

/// Head comment: purpose of the file, assumptions, and usage.
std::string head_comment(const Source& source);
/// "#define" lines: period, limits, and constants of the table.
std::string constants(const Source& source);
/// "#define" lines of the plausible range of every input, and of the value that replaces an implausible reading.
std::string plausible_constants(const Source& source);
/// Conversion of i_q to the equivalent DC current; empty for a brushed motor.
std::string foc_conversion(const Source& source);
/// Types of a step: input, state, reason and output.
std::string structures(const Source& source);
/// States the bounds of a table: its shortfall and its largest slopes.
std::string table_comment(const CurrentTable& table);
/// The derating table; allowed_function() is its interpolation.
std::string tables(const Source& source);
std::string allowed_function(const Source& source);
struct Rates {
  std::string text;
  bool calls_thermal_math = false;
};
/// Functions for dT/dt of every node, with the safety factor and for the nominal motor.
Rates rates(const Source& source);
/// Arrays of the values that the guard tries if a signal's reading is implausible.
std::string candidates(const Source& source);
/// Functions `start` and `step` with their helpers.
std::string step_functions(const Source& source);
/// The step function with a temperature sensor; empty if none is declared.
Rates sensor_functions(const Source& source);
/// Functions that save the state before power-off and restore it. `signature` identifies this guard, so that a buffer of another one is
/// refused.
std::string memory_functions(const Source& source, unsigned signature);

}  // namespace heatsoak::derate::c_header
