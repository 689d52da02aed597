// Which logs may be fitted to a motor: read before any equation is solved.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/measurement/quality.h"
#include "identify/measurement/recording.h"
#include "motor/motor.h"

namespace heatsoak {

struct Admission {
  std::vector<std::string> notes;       ///< sentences for the user about what looks odd but may be right
  std::vector<std::string> next_steps;  ///< what to do before more runs are taken
};

/// Throws Failure with every log's finding at once:
/// bad_input where rows are given twice or are both fitted and held out, where units, signs or sensors look wrong by
/// themselves or for this motor (with `takes_logs_as_they_are` these are only said); cannot_answer where a fitted log
/// can tell nothing about heat. `ambient_C`: of the air where a log has none, as the user states it.
Admission admit(const Motor& motor, std::span<const Recording> fitted, std::span<const Recording> held_out, bool takes_logs_as_they_are,
                double ambient_C = Assessment::kNotStated_C);

/// Whether rows of the recording were fitted: by their content, in files of fits that kept only names by the name.
bool was_fitted_to(const MotorFit& fit, const Recording& recording);

/// Throws Failure (bad_input) where the file was fitted to rows of a log: its figures know already what they tell.
void refuse_runs_of_the_file(const Motor& motor, std::span<const Recording> fitted, std::span<const Recording> held_out);

}  // namespace heatsoak
