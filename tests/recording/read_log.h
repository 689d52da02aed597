// Modified synthetic logs, and the report about them.
#pragma once

#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "log_files.h"
#include "recording/quality.h"
#include "recording/read_recording.h"
#include "synthetic_log.h"

namespace heatsoak::recording {

struct Read {
  Recording recording;
  RecordingReport report;
  DataQuality quality;
};

inline Read read_text(const std::string& text) {
  const LogFile file("log.csv", text);
  Read result;
  result.recording = read_recording(file.path(), {}, result.report);
  result.quality = assess(result.recording, result.report);
  return result;
}

/// Applies `change` to every row of a synthetic log: time, winding, stator, ambient, current.
inline std::string changed(const SyntheticLog& log, const std::function<void(int, std::vector<double>&)>& change) {
  std::istringstream lines(log.csv());
  std::string line;
  std::getline(lines, line);
  std::string text = line + "\n";
  for (int row = 0; std::getline(lines, line); ++row) {
    std::vector<double> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
      cells.push_back(std::stod(cell));
    }
    change(row, cells);
    text += fmt::format("{:.6g}", cells[0]);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      text += fmt::format(",{:.6g}", cells[i]);
    }
    text += "\n";
  }
  return text;
}
enum Column { time, winding, stator, ambient, current };

inline std::vector<int> lines_of(const LeftOut* entry) {
  std::vector<int> lines;
  for (const LineRange& range : entry != nullptr ? entry->lines : std::vector<LineRange>{}) {
    for (int line = range.first; line <= range.last; ++line) {
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace heatsoak::recording
