// Heat that has no name: what goes with a signal by a curve of its own, and what follows no signal.
#pragma once

#include <vector>

#include "identify/attribution/diagnosis.h"

namespace heatsoak {

/// Of a diagnosis that has its selection, its effects and its courses of unknown heat.
std::vector<Unexplained> unexplained_heat(const Diagnosis& told, const std::vector<MeasuredRun>& train);
/// What is left at the node where most is, however little.
Unexplained most_heat_left(const Diagnosis& told, const std::vector<MeasuredRun>& train);

}  // namespace heatsoak
