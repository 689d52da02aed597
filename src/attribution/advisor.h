// What to measure next: how much a short experiment would add to the evidence between two effects that the runs confuse.
#pragma once

#include <string>
#include <vector>

#include "attribution/diagnosis.h"

namespace heatsoak {

/// For every accepted effect with look-alikes: the experiment of the menu that separates it best from each of them (T-optimal:
/// D = min over the rival's size, and θ as far as the runs leave it open, of ½‖G·φ − G_rival·φ_rival‖² in whitened space, in nats), best
/// first. The unknown heat is supposed to be what is left after the diagnosis. The experiments take ten minutes each, at levels that the
/// runs reached and no hotter than they measured.
std::vector<Experiment> next_experiments(const Selection& selection, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
