// Next experiment: how much evidence a ten-minute run would add between two effects that these runs confound.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"

namespace heatsoak::diagnosis {

/// Returns, for each accepted effect and each effect confounded with it, the experiment that separates the two best; largest gain first.
/// The criterion is T-optimality (Atkinson and Fedorov 1975): D = min ½‖G·φ − G_rival·φ_rival‖² in whitened space, in nats. The minimum is
/// over the rival's size and over θ within its posterior. The unknown heat is that of the final fit. Each experiment lasts 10 min, with
/// levels and temperatures within those of the runs. If none adds 1 nat, the experiment is the catalogue's, without expected_nats.
std::vector<Experiment> next_experiments(const attribution::Selection& selection, const std::vector<estimation::MeasuredRun>& runs);

}  // namespace heatsoak::diagnosis
