// Wording of the findings of a friction test.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "friction/findings.h"

namespace heatsoak::present {

/// Returns how the logs were read.
std::string words_of(const friction::FrictionFinding& finding);
/// Returns a sentence with the suspicious value and a question about its likely cause.
std::string words_of(const friction::FrictionSuspicion& suspicion);
std::vector<std::string> words_of(const std::vector<friction::SuspicionOfTest>& suspicions);
/// Returns why 0 is written to the robot file.
std::string words_of(const friction::WrittenAsZero& finding);
std::string_view words_of(friction::WheelProblem problem);
std::string_view words_of(friction::Repeats repeats);
std::string_view words_of(friction::ExpectedFrom source);

}  // namespace heatsoak::present
