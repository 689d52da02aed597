// Between a motor file and a model of measured runs: what is fitted of it, and how what was found goes back into the file.
#pragma once

#include <string>
#include <vector>

#include "identify/attribution/diagnosis.h"
#include "motor/motor.h"

namespace heatsoak {

struct ModelOfLogs {
  ExtendedModel model;
  std::vector<Signal> needed;      ///< heat inputs that runs must have for it
  std::vector<std::string> notes;  ///< what is taken for granted because no log has it
};

/// The motor's network with its heat capacities and thermal resistances free. Where no recording has a current, all measured input
/// power heats the winding. Heat inputs that no recording has count as 0.
/// Throws Failure (bad_input) where the recordings have no heat input that the motor's effects turn into heat.
ModelOfLogs model_of_logs(const Motor& motor, const std::vector<Recording>& recordings);

/// The rows of a recording between two shares of its duration, 0 … 1; its name and conditions stay.
Recording part_of(const Recording& recording, double from_share, double to_share);

/// `original`, the text of the motor's file, with the diagnosis' thermal figures and its effects added: again a motor file.
std::string extended_motor_file(const std::string& original, const Motor& motor, const Diagnosis& diagnosis);

}  // namespace heatsoak
