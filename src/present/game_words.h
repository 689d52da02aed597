// Wording of the findings about a recorded game.
#pragma once

#include <string>
#include <vector>

#include "duty/game_to_demand.h"

namespace heatsoak::present {

std::string words_of(const duty::LogFault& fault);
std::string words_of(const duty::ImportNote& note);
/// Returns one finding per line. The last lines are the problems with their places.
std::vector<std::string> words_of(const duty::ImportReport& report);
/// Returns the report on the log and, if a robot was tracked, quality of the motion, gaps and share of time over the grip.
std::vector<std::string> words_of(const duty::GameDemand& game);
/// Returns the failure with what is known about the game.
base::Failure in_words(const duty::GameNotUsable& failure);

}  // namespace heatsoak::present
