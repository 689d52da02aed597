// Columns of a log that are not part of an operating point. Unmodelled heat may still depend on them.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/measured_run.h"
#include "recording/recording.h"

namespace heatsoak {

/// Returns these columns by key: the mean over each interval between `time_s`, in the column's unit, NaN if the log has no value there.
/// Includes a current that has both signs, because the network's laws use only its magnitude.
std::map<std::string, Eigen::VectorXd> columns_along(const Recording& recording, const std::vector<double>& time_s);

/// Returns a sentence for the user if the model has a curve over `column` and not all logs have that column; else an empty string.
std::string column_lacking(const std::string& column, std::span<const Recording> recordings);

/// Removes the columns that not all runs have, except `of_model`, over which the model already has a curve. Their effect would be
/// confounded with other differences between the runs. Returns the names of the removed columns.
std::vector<std::string> keep_common_columns(std::vector<MeasuredRun>& runs, std::string_view of_model);

/// Copies one of a run's columns into its operating points. Gaps take the nearest known value. If the run has no such column, the points
/// mark it as unknown (column_share 0). An empty key changes nothing.
void set_column(MeasuredRun& run, const std::string& key);
void set_column(std::vector<MeasuredRun>& runs, const std::string& key);

}  // namespace heatsoak
