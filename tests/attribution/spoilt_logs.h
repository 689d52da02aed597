// Defects of logs, for motors whose rows and readings are incomplete or wrong.
#pragma once

#include <vector>

#include "truth_motor.h"

namespace heatsoak::attribution::truth {

struct LogDefect {
  const char* name;
  void (*spoil)(recording::Recording& log, Dice& dice);
};

/// All defects, each for a log with one row per second.
const std::vector<LogDefect>& log_defects();

}  // namespace heatsoak::attribution::truth
