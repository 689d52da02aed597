// What a prediction cannot know of the effects in motor files.
#pragma once

#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// A line for each effect whose signal no duty has, with what is done about it; empty where there is none.
std::string silent_effects(std::span<const Motor> motors);

/// Of those the ones that go with a column of logs, which no prediction knows.
std::string columns_at_their_hottest(std::span<const Motor> motors);

/// A line for each condition that was stated, and for each effect that was seen under one of which nothing is said: heat is reckoned
/// with, cooling is not.
std::string effects_under_conditions(std::span<const Motor> motors);

}  // namespace heatsoak
