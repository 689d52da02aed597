// The pictures of a friction test, after figures 4, 6, 7 and 8 of ETDP 2025; one colour per wheel in all of them.
#pragma once

#include <string>

#include "identify/friction/friction_fit.h"
#include "identify/friction/steady_parts.h"
#include "report/chart.h"

namespace heatsoak {

/// Offset of every heading with the fitted f(θ), and damping of every heading, over the direction of travel.
Chart friction_chart(const FrictionFit& fit, const std::string& robot, const std::string& subtitle);

/// Voltage over wheel speed of every steady leg.
Chart voltage_chart(const SteadyParts& steady, const FrictionFit& fit, const std::string& robot, bool with_return_legs);

}  // namespace heatsoak
