// Sensitivities to terms that a model lacks. A network with all of them added at size 0 behaves like the original one, and provides them.
#pragma once

#include <span>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

/// Returns sensitivities of the readings along the path of `fitted`, in K (n·s rows), with the stated sensor errors of the run. There is
/// one column per parameter in `wanted`, per unit; then one per added node, per kelvin of its start temperature. `network` is that of
/// `fitted` with terms added at negligible size. Its nodes after those of `fitted` start at ambient temperature. `parameters`: values in
/// this run of the network's leading parameters. The network is linearised once per interval, at the midpoint.
Columns added_sensitivities(const thermal::Network& network, std::span<const double> parameters, const std::vector<int>& wanted,
                            const LinearisedRun& fitted, const MeasuredRun& run);

}  // namespace heatsoak::estimation
