// Measured logs on the command line, LOG or LOG@0-60%, and options for reading them.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "estimation/measured_run.h"
#include "input/data_folders.h"
#include "recording/recording.h"

namespace heatsoak {

struct LogOptions {
  std::string map;
  std::optional<double> ambient_C = {};  ///< for logs without an ambient temperature
  bool takes_logs_as_they_are = false;
};

/// --map, --ambient and --as-is.
void add_log_options(CLI::App& app, LogOptions& options);

/// Reads logs. Each text is LOG or LOG@FROM-TO%, a part of its time; names are resolved by log_named(). Appends the reader's notes to
/// `notes`. Throws Failure (bad_input).
std::vector<Recording> read_logs(const DataFolders& folders, const std::vector<std::string>& texts, const LogOptions& options,
                                 std::vector<std::string>& notes);

/// Renames recordings so that files of the same name in different folders differ: all of that name get their folder as a prefix
/// ("monday/run"). Names of fitted logs do not depend on the hold-out logs.
void make_names_distinct(std::vector<Recording>& fitted, std::vector<Recording>& held_out);

}  // namespace heatsoak
