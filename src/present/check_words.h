// Words of the outcomes of `check`.
#pragma once

#include <span>
#include <string>

#include "check/run_checks.h"

namespace heatsoak::present {

/// States how many limits hold, do not hold and cannot be evaluated, without a full stop.
std::string conclusion_words(std::span<const check::Outcome> outcomes);

/// Returns the measured value with its unit; "–" if the threshold was not evaluated.
std::string value_words(const check::Outcome& outcome);
/// Returns the margin with its sign and unit; "–" if the threshold was not evaluated.
std::string margin_words(const check::Outcome& outcome);
/// Returns the limit: "at most 150 °C".
std::string limit_words(const check::Outcome& outcome);

/// Returns robot, duty and motor of a check, without those that it lacks, or its command.
std::string subject_words(const check::Check& check);

/// Returns the basis of the value; empty without a value, or if it needs no explanation.
std::string basis_words(const check::Outcome& outcome);
/// States why a threshold of that limit could not be evaluated.
std::string words_of(const check::Reason& reason, const check::Limit& limit);
/// States why the limit is broken, the threshold could not be evaluated or --update left the limit as it is; else empty.
std::string reason_words(const check::Outcome& outcome);
/// Returns reason and basis of a threshold that fails, and the basis of one that passes.
std::string explanation_words(const check::Outcome& outcome);
/// Returns the place to correct: that of the file's problem if it prevents the evaluation, otherwise that of the limit.
base::Location place_of(const check::Outcome& outcome);
/// Returns explanation_words() without the place_of() that they may begin with, for a message beside that place.
std::string unlocated_explanation(const check::Outcome& outcome);
/// Returns explanation_words() behind "file:line:column: " of place_of(), as compilers write it.
std::string located_explanation(const check::Outcome& outcome);

}  // namespace heatsoak::present
