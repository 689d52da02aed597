// Documents of `log inspect` and `log convert`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "present/document.h"
#include "recording/inspect_log.h"
#include "recording/named_logs.h"
#include "recording/recording_report.h"

namespace heatsoak::present {

Document logs_document(std::span<const recording::InspectedLog> logs);
/// `out` is the name of the canonical file.
Document conversion_document(const recording::ConvertedLog& log, const std::string& out);

/// Returns the rejected samples, one sentence per channel and reason: "798 samples of winding_C: saturated; line 12-14, 20".
std::vector<std::string> left_out_sentences(const recording::RecordingReport& report);

/// Returns the reader's changes and remarks, one sentence each. Parts of one log give the same sentences; they are listed once.
std::vector<std::string> reading_words(std::span<const recording::LogReading> readings);

}  // namespace heatsoak::present
