// Words about limits for the diagnostics of check files. src/present uses them for the same findings of a run.
#pragma once

#include <string>
#include <string_view>

#include "check/limit.h"

namespace heatsoak::check {

/// Returns what is wrong with a text and what was expected.
std::string words_of(const LimitProblem& problem, const ThresholdType& type);
/// Returns the same for a number without words, quotes and unit.
std::string bare_limit_problem(std::string_view number, const ThresholdType& type);

/// Returns the origin: "the motor's own winding limit".
std::string_view words_of(LoosestBy origin);
/// Returns why the limit is not permitted and what was expected.
std::string words_of(const Looseness& found, const ThresholdType& type);

}  // namespace heatsoak::check
