// Document of `log inspect`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "present/document.h"
#include "recording/named_logs.h"
#include "recording/quality.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::present {

/// Adds one log to the document. `recording`: the rows of Assessment::condensed(), or the whole log.
void add_log(Document& document, const recording::Recording& recording, const recording::RecordingReport& report,
             const recording::DataQuality& quality);

/// Returns the rejected samples, one sentence per channel and reason: "798 samples of winding_C: saturated; line 12-14, 20".
std::vector<std::string> left_out_sentences(const recording::RecordingReport& report);

/// Returns the reader's changes and remarks, one sentence each. Parts of one log give the same sentences; they are listed once.
std::vector<std::string> reading_words(std::span<const recording::LogReading> readings);

}  // namespace heatsoak::present
