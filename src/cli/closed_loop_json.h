// JSON of the games of `evaluate --closed-loop`.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "simulate/closed_loop_rank.h"

namespace heatsoak {

nlohmann::ordered_json closed_loop_json(const ClosedLoopRank& rank, std::uint64_t seed);

}  // namespace heatsoak
