// Note about the motors whose verdict the samples leave undecided.
#pragma once

#include <span>
#include <string>

#include "present/document.h"
#include "select/evaluate.h"

namespace heatsoak::present {

/// Formats "about 45 more games needed" for an undecided motor.
std::string needed_words(const select::MotorEvaluation& motor);

/// Adds one note for all undecided motors: what they count as, and how many samples will probably decide. Adds nothing if all are decided.
void add_undecided_note(Document& document, std::span<const select::MotorEvaluation> results);

}  // namespace heatsoak::present
