// Columns of a log that are not part of an operating point. Unmodelled heat may still depend on them.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/measured_run.h"
#include "recording/recording.h"

namespace heatsoak::estimation {

/// Returns these columns by key: the mean over each interval between `time_s`, in the column's unit, NaN if the log has no value there.
/// Includes a current that has both signs, because the network's laws use only its magnitude.
std::map<std::string, Eigen::VectorXd> columns_along(const recording::Recording& recording, const std::vector<double>& time_s);

/// Returns those of `columns`, over which the model has curves, that not all logs have; nothing if all have them.
std::optional<ColumnsLacking> columns_lacking(std::span<const std::string> columns, std::span<const recording::Recording> recordings);

/// Removes the columns that not all runs have, except `of_model`, over which the model already has a curve. Their effect would be
/// confounded with other differences between the runs. Returns the names of the removed columns.
std::vector<std::string> keep_common_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> of_model);

/// Copies columns of a run, at most kLogColumns, into its operating points in this order. Gaps take the nearest known value. The points
/// mark columns that the run lacks as unknown (share 0).
void set_columns(MeasuredRun& run, std::span<const std::string> keys);
void set_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> keys);

}  // namespace heatsoak::estimation
