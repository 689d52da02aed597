#include "duty/match/match_inputs.h"

#include <algorithm>

namespace heatsoak {
namespace {

constexpr Range kSeconds = Range::between(0.1, 600.0);
constexpr Range kShare = Range::between(0.0, 1.0);

// clang-format off
constexpr std::array kSpecs = {
    MatchInputSpec{{"running_mean", "s", kSeconds, "mean stretch of play between interruptions"}, &MatchValues::running_mean_s},
    MatchInputSpec{{"stop_mean", "s", kSeconds, "mean length of a stop"}, &MatchValues::stop_mean_s},
    MatchInputSpec{{"placement_share", "", kShare, "part of interruptions with ball placement"}, &MatchValues::placement_share},
    MatchInputSpec{{"placement_mean", "s", kSeconds, "mean length of a ball placement, at most 30 s"}, &MatchValues::placement_mean_s},
    MatchInputSpec{{"halt_count", "", Range::between(0.0, 20.0), "mean number of halts in a half"}, &MatchValues::halt_count},
    MatchInputSpec{{"halt_mean", "s", kSeconds, "mean length of a halt"}, &MatchValues::halt_mean_s},
    MatchInputSpec{{"timeout_count", "", Range::between(0.0, 8.0), "mean number of timeouts, both teams"}, &MatchValues::timeout_count},
    MatchInputSpec{{"retarget_mean", "s", Range::between(0.05, 60.0), "mean time between two new targets in play"}, &MatchValues::retarget_mean_s},
    MatchInputSpec{{"distance_median", "m", Range::between(0.01, 12.0), "median distance to a new target, attacker"}, &MatchValues::distance_median_m},
    MatchInputSpec{{"aggressiveness", "", Range::between(0.1, 1.0), "part of the robot's limits that is used"}, &MatchValues::aggressiveness},
    MatchInputSpec{{"duels_per_min", "1/min", Range::between(0.0, 30.0), "pushing duels per minute of play, attacker"}, &MatchValues::duels_per_min},
    MatchInputSpec{{"duel_mean", "s", kSeconds, "mean length of a duel"}, &MatchValues::duel_mean_s},
    MatchInputSpec{{"duel_push_share", "", kShare, "force of a duel, part of the largest that the robot can hold in its direction before a wheel slides"}, &MatchValues::duel_push_share},
};
// clang-format on

}  // namespace

std::span<const MatchInputSpec> match_input_specs() { return kSpecs; }

MatchValues MatchInputs::nominal() const {
  MatchValues values;
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    values.*kSpecs[i].value = figures[i].value;
  }
  return values;
}

MatchValues MatchInputs::draw(Random& random) const {
  MatchValues values;
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    values.*kSpecs[i].value = figures[i].quantile(random.uniform());
  }
  return values;
}

MatchInputs read_match_inputs(Reader& table) {
  MatchInputs inputs;
  constexpr std::array<std::string_view, 2> kDivisions{"A", "B"};
  inputs.division = table.choice("division", kDivisions, Need::required) == "B" ? Division::b : Division::a;
  if (const std::optional<std::string> role = table.choice("role", kRoleNames, Need::required)) {
    inputs.role = static_cast<Role>(std::ranges::find(kRoleNames, *role) - kRoleNames.begin());
  }
  inputs.overtime = table.flag("overtime", Need::optional).value_or(false);
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    inputs.figures[i] = table.figure(kSpecs[i].spec, Need::required).value_or(Figure{});
  }
  return inputs;
}

}  // namespace heatsoak
