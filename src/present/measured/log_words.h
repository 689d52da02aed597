// Wording of the findings about a log.
#pragma once

#include <string>
#include <vector>

#include "recording/findings.h"

namespace heatsoak::present {

/// Returns a sentence with the suspicious value and a question about its likely cause.
std::string words_of(const recording::Suspicion& suspicion);
std::string words_of(const recording::SuspicionOfLog& suspicion);
std::string words_of(const recording::RespondsLate& finding);
/// Returns why a delay is not determinable.
std::string words_of(const recording::NoDelayReason& reason);
std::string words_of(const recording::Lack& lack);
std::string words_of(const recording::ReadingNote& note);

std::vector<std::string> words_of(const std::vector<recording::Suspicion>& suspicions);
std::vector<std::string> words_of(const std::vector<recording::Lack>& lacks);
std::vector<std::string> words_of(const std::vector<recording::ReadingNote>& notes);

/// Returns the unit in which a time seems to be: "minutes".
std::string_view words_of(recording::TimeUnit unit);

}  // namespace heatsoak::present
