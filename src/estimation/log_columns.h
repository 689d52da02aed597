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

namespace heatsoak::estimation {

/// Returns the means of all columns that are not part of an operating point, over each interval between `time_s`: by key, in the column's
/// unit, NaN if the log has no value there. Temperatures are left out. current_A is included for its sign, because the network's laws use
/// only its magnitude.
std::map<std::string, Eigen::VectorXd> columns_along(const recording::Recording& recording, const std::vector<double>& time_s);

/// Returns a note for each log that lacks a column. `columns` are those over which the model has curves.
std::vector<RunNote> columns_lacking(std::span<const std::string> columns, std::span<const recording::Recording> recordings);

/// Returns the time for which a column of the log is blank, of blanks of Thresholds::slow_s or more; 0 without the column.
double long_blanks_s(const recording::Recording& recording, std::string_view column);

/// Removes the columns that not all runs have, except `of_model`, over which the model already has a curve. Their effect would be
/// confounded with other differences between the runs. Returns the names of the removed columns.
std::vector<std::string> keep_common_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> of_model);

/// Copies columns of a run, at most kLogColumns, into its operating points in this order. Gaps take the nearest known value. If the
/// run lacks a column, its value is 0 and unknown (OperatingPoint::known).
void set_columns(MeasuredRun& run, std::span<const std::string> keys);
void set_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> keys);

}  // namespace heatsoak::estimation
