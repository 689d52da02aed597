// Columns of a log that no operating point has by itself: an unknown heat may follow them all the same.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "identify/measured_run.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// By key, the mean over each interval between `time_s`, in the column's unit; NaN where it has no value. A current of both signs is one of
/// them: laws take its magnitude.
std::map<std::string, Eigen::VectorXd> columns_along(const Recording& recording, const std::vector<double>& time_s);

/// Puts one of a run's columns into its operating points. What the run does not have is unknown there; no key
/// changes nothing.
void set_column(MeasuredRun& run, const std::string& key);
void set_column(std::vector<MeasuredRun>& runs, const std::string& key);

}  // namespace heatsoak
