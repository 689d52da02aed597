// Reports heat without a name: accepted curves over signals, and unknown heat that follows no signal.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"

namespace heatsoak::diagnosis {

/// Returns the accepted curves. If there are none and the selection is unexplained, returns the node with the most unknown heat. Needs the
/// selection, effects and flux of the diagnosis.
std::vector<Unexplained> unexplained_heat(const Diagnosis& described, const std::vector<estimation::MeasuredRun>& train);

}  // namespace heatsoak::diagnosis
