// The answers of `log`: assesses a file of measurements, or converts it to canonical CSV.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "input/data_folders.h"
#include "recording/condensed_recording.h"
#include "recording/quality.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

struct InspectedLog {
  CondensedRecording condensed;  ///< with the channels, motor and conditions of the log
  RecordingReport report;
  DataQuality quality;
  std::string suggested_mapping;  ///< mapping file to start from, if a column is not used as a quantity of the table may be; else empty

  /// Returns whether the log can be used for at least one purpose.
  [[nodiscard]] bool is_good() const { return quality.thermal.is_good() || quality.drive.is_good(); }
};

/// Reads and assesses logs, with bounded memory for each. `names` are files, or names as log_named() resolves them; `map` is the mapping of
/// all, or empty for the file beside each log, if there is one. Throws Failure as mapping_for() and RecordingStream do.
std::vector<InspectedLog> inspect_logs(const input::DataFolders& folders, const std::vector<std::string>& names, const std::string& map);

struct ConvertedLog {
  std::filesystem::path file;
  RecordingReport report;
  std::size_t channels = 0;
  std::string text;  ///< canonical CSV
};

/// Reads and converts one log. Arguments and exceptions as above.
ConvertedLog convert_log(const input::DataFolders& folders, const std::string& name, const std::string& map);

}  // namespace heatsoak::recording
