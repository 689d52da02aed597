// Reads the measured logs that a user names: LOG, or LOG@0-60% for a part of its time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/collected_failures.h"
#include "input/data_folders.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

struct LogChoice {
  input::DataFolders folders = {};       ///< folders of log_named()
  std::string map = {};                  ///< mapping of all logs; empty: the file beside each log, if there is one
  std::optional<double> ambient_C = {};  ///< for logs without an ambient temperature
  bool takes_logs_as_they_are = false;   ///< accept logs whose units or sensors look wrong
};

/// Omitted samples and other remarks of one log; parts of one log share one entry.
struct LogReading {
  std::string log;  ///< stem of the file
  RecordingReport report;
};

struct NamedLogs {
  std::vector<Recording> fitted;
  std::vector<Recording> held_out;
  std::vector<LogReading> readings;  ///< reports of the logs in `fitted`, then of those in `held_out`
  LogChoice choice;                  ///< choice that they were read with
  base::CollectedFailures unread;    ///< failures of the logs that could not be read
};

/// Reads the logs. Recordings whose files have the same name in different folders get the folder as a prefix ("monday/run"). The names
/// of several parts of one log end with the part ("run@0-60%"). Hold-out logs do not change the names of fitted logs. Logs that cannot be read are
/// in `unread`; the caller reports them with the problems of the other logs.
NamedLogs read_usable_logs(const std::vector<std::string>& fitted, const std::vector<std::string>& held_out, const LogChoice& choice);

}  // namespace heatsoak::recording
