// Document of `log inspect`.
#pragma once

#include <string>
#include <vector>

#include "present/document.h"
#include "recording/quality.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::present {

/// Adds one log to the document. `recording` holds at least the data that the assessment keeps.
void add_log(Document& document, const Recording& recording, const RecordingReport& report, const DataQuality& quality);

/// Returns the rejected samples, one sentence per channel and reason: "798 samples of winding_C: saturated; line 12-14, 20".
std::vector<std::string> left_out_sentences(const RecordingReport& report);

}  // namespace heatsoak::present
