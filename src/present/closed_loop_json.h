// JSON of the games of `evaluate --closed-loop`.
#pragma once

#include <cstdint>

#include "present/json.h"
#include "simulate/closed_loop_rank.h"

namespace heatsoak::present {

Json closed_loop_json(const simulate::ClosedLoopRank& rank, std::uint64_t seed);

}  // namespace heatsoak::present
