// Reads a file of measurements into a recording and a report of omitted samples.
#pragma once

#include <filesystem>

#include "recording/mapping.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

/// Reads all rows of `log`; drops channels without any number. Omitted samples and exceptions are those of RecordingStream. Only used
/// columns need memory.
Recording read_recording(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report);

}  // namespace heatsoak::recording
