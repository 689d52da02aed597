// Charts of a friction test, after parameters 4, 6, 7 and 8 of ETDP 2025; one colour per wheel in all of them.
#pragma once

#include <vector>

#include "friction/friction_job.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Returns two charts; none for a roll-out. The first, left out if there are no points to show, has offset and damping of every heading
/// over the direction of travel, with the fitted f(θ). The second has voltage over wheel speed: one heading with lines whose offsets are
/// the static friction, and all headings after subtracting the friction.
std::vector<report::Chart> friction_charts(const friction::FrictionJob& job, const friction::FrictionAnswer& answer);

}  // namespace heatsoak::present
