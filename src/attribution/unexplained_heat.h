// Heat that has no name: what goes with a signal by a curve of its own, and what follows no signal.
#pragma once

#include <vector>

#include "attribution/diagnosis.h"

namespace heatsoak {

/// Of a diagnosis that has its selection, its effects and its courses of unknown heat.
std::vector<Unexplained> unexplained_heat(const Diagnosis& described, const std::vector<MeasuredRun>& train);

}  // namespace heatsoak
