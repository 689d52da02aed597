// A file of measurements -> a recording and a report of what was left out.
#pragma once

#include <filesystem>

#include "identify/measurement/mapping.h"
#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"

namespace heatsoak {

/// Reads `log`. Rows and samples that are no measurement (blank, not numbers, repeated or backward times, saturated,
/// frozen, outliers of temperatures) are left out and reported, never guessed. Memory grows with the columns that are used only.
/// Throws Failure: bad_input for a file that is no such table, has no such column or whose time does not increase at all;
/// cannot_answer where nothing is left.
Recording read_recording(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report);

}  // namespace heatsoak
