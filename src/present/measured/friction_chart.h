// Charts of a friction test, after parameters 4, 6, 7 and 8 of ETDP 2025; one colour per wheel in all of them.
#pragma once

#include <string>

#include "friction/friction_fit.h"
#include "friction/steady_parts.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Offset of every heading with the fitted f(θ), and the damping of every heading, over the direction of travel.
report::Chart friction_chart(const friction::FrictionFit& fit, const std::string& robot, const std::string& subtitle);

/// Voltage over wheel speed: one heading with lines whose offsets are the static friction, and all headings after subtracting the friction.
report::Chart voltage_chart(const friction::SteadyParts& steady, const friction::FrictionFit& fit, const robot::Kinematics& kinematics,
                            const std::string& robot, const friction::FitSettings& settings);

}  // namespace heatsoak::present
