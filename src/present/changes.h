// Changes that cool a motor, as part of the answer of `evaluate`.
#pragma once

#include "present/document.h"
#include "simulate/evaluation.h"

namespace heatsoak::present {

/// Adds the most helpful change to the headline, and a table of three at most: those of the robot first. `is_drawn` states whether the
/// effects are means of several games.
void add_changes(Document& document, const simulate::SuggestedChanges& changes, bool is_drawn);

}  // namespace heatsoak::present
