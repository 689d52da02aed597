#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/derating.h"

namespace heatsoak::present {
namespace {

Json json(const derate::TablePlace& place) {
  return {{"difference_A", rounded(place.difference_A, 4)}, {"committed_A", rounded(place.committed_A, 4)},
          {"fresh_A", rounded(place.fresh_A, 4)},           {"speed_rad_per_s", rounded(place.speed_rad_per_s, 3)},
          {"stator_C", rounded(place.stator_C, 2)},         {"winding_C", rounded(place.winding_C, 2)}};
}

}  // namespace

Json table_check_json(const derate::TableCheck& check) {
  const derate::CommittedTable& committed = check.committed;
  const auto text = [](const std::string& words) { return words.empty() ? Json() : Json(words); };
  Json lines = Json::array();
  for (const derate::HeaderDifference& each : check.found.differing) {
    lines.push_back({{"line", each.line}, {"committed", each.text}, {"fresh", each.other_text}});
  }
  Json result{{"file", committed.file.string()},
              {"motor", text(committed.motor_id)},
              {"robot", text(committed.robot_id)},
              {"written_by", text(committed.version)},
              {"holds", check.found.holds()},
              {"ignored_share", derate::kIgnored_share},
              {"excess", json(check.found.excess)},
              {"lost", json(check.found.lost)},
              {"differing_line", lines.empty() ? Json() : lines.front()["line"]},
              {"differing_lines", lines}};
  return base::with_ranges(std::move(result), {{"difference_A", base::kNotNegative},
                                               {"committed_A", base::kNotNegative},
                                               {"fresh_A", base::kNotNegative},
                                               {"ignored_share", base::kShare}});
}

}  // namespace heatsoak::present
