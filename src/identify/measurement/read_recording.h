// A file of measurements -> a recording and a report of what was left out.
#pragma once

#include <filesystem>

#include "identify/measurement/mapping.h"
#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"

namespace heatsoak {

/// All rows of `log` at once, without channels that hold no number; what is left out and what is thrown is RecordingStream's. Memory
/// grows with the columns that are used only.
Recording read_recording(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report);

}  // namespace heatsoak
