// Measured logs on the command line: LOG or LOG@0-60%, and how they are read.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "identify/measured_run.h"
#include "identify/measurement/recording.h"
#include "input/data_folders.h"

namespace heatsoak {

struct LogOptions {
  std::string map;
  double ambient_C = MeasuredRunOptions::kNotStated_C;  ///< where a log has none
  bool takes_logs_as_they_are = false;
};

/// --map, --ambient and --as-is.
void add_log_options(CLI::App& app, LogOptions& options);

/// `texts` are LOG or LOG@FROM-TO%, that part of its time; see log_named. Notes of the reader are added to `notes`.
/// Throws Failure (bad_input).
std::vector<Recording> read_logs(const DataFolders& folders, const std::vector<std::string>& texts, const LogOptions& options,
                                 std::vector<std::string>& notes);

/// Files of one name in different folders are no parts of one run: where there are such, all of the name get that of their folder, too
/// ("monday/run"). Names of fitted logs do not depend on the held-out ones.
void tell_apart(std::vector<Recording>& fitted, std::vector<Recording>& held_out);

}  // namespace heatsoak
