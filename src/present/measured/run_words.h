// Wording of the findings about the rows of logs that runs are made of.
#pragma once

#include <string>
#include <vector>

#include "estimation/findings.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the part that a signal belongs to: "winding" for "winding_C".
std::string part_of(const std::string& signal);

/// Returns the note as one sentence.
std::string words_of(const estimation::RunNote& note);
/// Temperatures may be wrong after a warning.
Severity severity_of(const estimation::RunNote& note);
/// Returns the reasons why rows are not used, joined by commas.
std::string words_of(const std::vector<estimation::LossOfRows>& reasons);

}  // namespace heatsoak::present
