#include "recording/read_recording.h"

#include <algorithm>

#include "recording/fingerprint.h"
#include "recording/recording_stream.h"

namespace heatsoak::recording {
namespace {

/// Reserves memory for the expected number of rows. Growth by doubling would copy the columns and need twice the memory.
void make_room(Recording& recording, const std::filesystem::path& log, std::size_t bytes_read) {
  constexpr double kMargin_ratio = 1.03;
  std::error_code unknown;
  const std::uintmax_t file_bytes = std::filesystem::file_size(log, unknown);
  if (unknown || file_bytes <= bytes_read) {
    return;
  }
  const auto rows = static_cast<std::size_t>(kMargin_ratio * static_cast<double>(recording.rows()) * static_cast<double>(file_bytes) /
                                             static_cast<double>(bytes_read));
  recording.time_s.reserve(rows);
  recording.line.reserve(rows);
  for (Channel& channel : recording.channels) {
    channel.values.reserve(rows);
  }
}

void append(Recording& recording, const Recording& part) {
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (const std::size_t begin : part.run_begins) {
    recording.run_begins.push_back(recording.rows() + begin);
  }
  add(recording.time_s, part.time_s);
  add(recording.line, part.line);
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    add(recording.channels[c].values, part.channels[c].values);
  }
}

}  // namespace

Recording read_recording(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report) {
  RecordingStream stream(log, mapping, report);
  Recording recording;
  if (stream.next(recording)) {
    make_room(recording, log, stream.bytes_read());
    for (Recording part; stream.next(part);) {
      append(recording, part);
    }
  }
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    if (stream.has_numbers(c)) {
      channels.push_back(std::move(recording.channels[c]));
    }
  }
  recording.channels = std::move(channels);
  if (recording.rows() > 0) {
    recording.content = content_hash(recording);
    recording.content_begin_s = recording.time_s.front();
  }
  return recording;
}

}  // namespace heatsoak::recording
