#include "recording/inspect_log.h"

#include <algorithm>
#include <variant>

#include "recording/mapping.h"
#include "recording/read_recording.h"
#include "recording/recording_stream.h"
#include "recording/suggested_mapping.h"
#include "recording/write_recording.h"

namespace heatsoak::recording {
namespace {

/// Returns whether the note is about a column that may contain a quantity of the table under another name.
bool may_be_mapped(const ReadingNote& note) {
  return std::holds_alternative<ColumnWithoutUnit>(note) || std::holds_alternative<AdditionalSignal>(note);
}

InspectedLog inspected(const std::filesystem::path& file, const std::string& map) {
  InspectedLog log;
  const Mapping mapping = mapping_for(file, map);
  RecordingStream stream(file, mapping, log.report);
  Assessment assessment;
  for (Recording part; stream.next(part);) {
    assessment.add(part);
  }
  if (mapping.is_canonical() && std::ranges::any_of(log.report.notes, may_be_mapped)) {
    log.suggested_mapping = suggested_mapping(stream.header());
  }
  log.quality = assessment.conclude(log.report);
  log.condensed = assessment.condensed();
  return log;
}

}  // namespace

std::vector<InspectedLog> inspect_logs(const input::DataFolders& folders, const std::vector<std::string>& names, const std::string& map) {
  std::vector<InspectedLog> logs;
  for (const std::string& name : names) {
    logs.push_back(inspected(input::log_named(folders, name), map));
  }
  return logs;
}

ConvertedLog convert_log(const input::DataFolders& folders, const std::string& name, const std::string& map) {
  ConvertedLog log{.file = input::log_named(folders, name), .report = {}, .channels = 0, .text = {}};
  const Recording recording = read_recording(log.file, mapping_for(log.file, map), log.report);
  log.channels = recording.channels.size();
  log.text = to_canonical_csv(recording);
  return log;
}

}  // namespace heatsoak::recording
