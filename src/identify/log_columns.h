// Columns of a log that no operating point has by itself: an unknown heat may follow them all the same.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/measured_run.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// By key, the mean over each interval between `time_s`, in the column's unit; NaN where it has no value. A current of both signs is one of
/// them: laws take its magnitude.
std::map<std::string, Eigen::VectorXd> columns_along(const Recording& recording, const std::vector<double>& time_s);

/// A sentence where a model's curve is over a column that not all logs have; else empty.
std::string column_lacking(const std::string& column, std::span<const Recording> recordings);

/// What a run lacks cannot be told from what follows it: keeps of the columns those that all runs have, and the one that the model has a
/// curve over already; names the others.
std::vector<std::string> keep_common_columns(std::vector<MeasuredRun>& runs, std::string_view of_model);

/// Puts one of a run's columns into its operating points. Where it is not known for a while it is what it was
/// or will be, whichever is nearer; where the run does not have it at all it is unknown. No key changes nothing.
void set_column(MeasuredRun& run, const std::string& key);
void set_column(std::vector<MeasuredRun>& runs, const std::string& key);

}  // namespace heatsoak
