#include "present/closed_loop_json.h"

#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/closed_loop.h"

namespace heatsoak::present {
namespace {

Json json(const simulate::GameSpread& spread, int decimals) {
  return {{"nominal", rounded(spread.nominal, decimals)}, {"low", rounded(spread.low, decimals)}, {"high", rounded(spread.high, decimals)}};
}

}  // namespace

Json closed_loop_json(const simulate::ClosedLoopRank& rank, std::uint64_t seed) {
  const simulate::GameDrives& drives = rank.drives;
  if (drives.games.empty()) {
    return {{"verdict", select::to_string(rank.verdict)}, {"games", 0}, {"why_none", why_not_driven(drives)}};
  }
  Json answer{{"verdict", select::to_string(rank.verdict)},
              {"games", drives.games.size()},
              {"first_seed", seed},
              {"winding_peak_C", json(drives.spread(&simulate::DriveScore::winding_peak_C), 2)},
              {"stator_peak_C", json(drives.spread(&simulate::DriveScore::stator_peak_C), 2)},
              {"current_rms_A", json(drives.spread(&simulate::DriveScore::current_rms_A), 4)},
              {"distance_m", json(drives.spread(&simulate::DriveScore::distance_m), 2)},
              {"tracking_rms_m", json(drives.spread(&simulate::DriveScore::tracking_rms_m), 6)},
              {"tracking_most_m", json(drives.spread(&simulate::DriveScore::tracking_most_m), 5)},
              {"slip_m", json(drives.spread(&simulate::DriveScore::slip_m), 4)},
              {"lowest_battery_V", json(drives.spread(&simulate::DriveScore::lowest_battery_V), 3)},
              {"battery_empty_s", json(drives.spread(&simulate::DriveScore::battery_empty_s), 3)}};
  answer["guard_limited_s"] = drives.is_guarded ? json(drives.spread(&simulate::DriveScore::guard_limited_s), 3) : Json();
  const std::optional<simulate::GameSpread> observer_C = drives.spread(&simulate::DriveScore::guard_winding_peak_C);
  answer["guard_winding_peak_C"] = observer_C ? json(*observer_C, 2) : Json();
  answer["why_no_guard"] = drives.why_no_guard ? Json(drives.why_no_guard->message()) : Json();
  return base::with_ranges(std::move(answer), {{"current_rms_A", base::kNotNegative},
                                               {"distance_m", base::kNotNegative},
                                               {"tracking_rms_m", base::kNotNegative},
                                               {"tracking_most_m", base::kNotNegative},
                                               {"slip_m", base::kNotNegative},
                                               {"lowest_battery_V", base::kNotNegative},
                                               {"battery_empty_s", base::kNotNegative},
                                               {"guard_limited_s", base::kNotNegative}});
}

}  // namespace heatsoak::present
