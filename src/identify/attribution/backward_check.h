// Which of the terms that were taken in one after the other stay in the end.
#pragma once

#include "identify/attribution/selection.h"

namespace heatsoak {

/// Drops from `selection` what later terms have made superfluous, and effects of the catalogue that cannot be told from all the others
/// together: these are refused.
void check_backwards(Selection& selection, const SelectionInput& input, const SelectionRules& rules, RefitOptions options);

/// The figures of what stays, averaged over what is probable of unknown heat and of sensors' errors beside it. Drops what has no evidence
/// left there: `options` as the selection used them.
void settle(Selection& selection, const SelectionInput& input, const SelectionRules& rules, RefitOptions options);

}  // namespace heatsoak
