#include "duty/match/match_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <tuple>

namespace heatsoak::duty {
namespace {

constexpr base::Range kSeconds = base::Range::between(0.1, 600.0);
constexpr base::Range kShare = base::Range::between(0.0, 1.0);
constexpr base::Range kFactor = base::Range::between(0.1, 4.0);
constexpr base::Range kAngle = base::Range::between(0.0, std::numbers::pi);

// clang-format off
constexpr std::array kSpecs = {
    MatchInputSpec{{"running_mean", "s", kSeconds, "mean interval of play between interruptions, unless the half ends first"}, &MatchValues::running_mean_s},
    MatchInputSpec{{"stop_mean", "s", kSeconds, "mean length of a stop"}, &MatchValues::stop_mean_s},
    MatchInputSpec{{"stop_shortest", "s", base::Range::between(0.0, 600.0), "length of the shortest stop, part of the mean"}, &MatchValues::stop_shortest_s},
    MatchInputSpec{{"placement_share", "", kShare, "share of the interruptions with ball placement"}, &MatchValues::placement_share},
    MatchInputSpec{{"placement_mean", "s", base::Range::between(0.1, 29.0), "mean length of a ball placement, each at most 30 s"}, &MatchValues::placement_mean_s},
    MatchInputSpec{{"halt_count", "", base::Range::between(0.0, 20.0), "mean number of halts in a half of 300 s"}, &MatchValues::halt_count},
    MatchInputSpec{{"halt_mean", "s", kSeconds, "mean length of a halt"}, &MatchValues::halt_mean_s},
    MatchInputSpec{{"timeout_count", "", base::Range::between(0.0, 8.0), "mean number of timeouts in two halves of 300 s, both teams"}, &MatchValues::timeout_count},
    MatchInputSpec{{"retarget_mean", "s", base::Range::between(0.05, 60.0), "mean time between two new targets, unless play ends first"}, &MatchValues::retarget_mean_s},
    MatchInputSpec{{"distance_median", "m", base::Range::between(0.01, 12.0), "median distance to a new target in play, attacker"}, &MatchValues::distance_median_m},
    MatchInputSpec{{"distance_spread", "", base::Range::between(0.0, 3.0), "spread of these distances: standard deviation of their natural logarithm"}, &MatchValues::distance_spread_ratio},
    MatchInputSpec{{"turn", "rad", kAngle, "largest turn from one target to the next, either way"}, &MatchValues::turn_rad},
    MatchInputSpec{{"aggressiveness", "", base::Range::between(0.1, 1.0), "share of the robot's limits that is used"}, &MatchValues::aggressiveness},
    MatchInputSpec{{"duels_per_min", "1/min", base::Range::between(0.0, 30.0), "number of pushing duels per minute of play, attacker"}, &MatchValues::duels_per_min},
    MatchInputSpec{{"duel_mean", "s", kSeconds, "mean length of a duel, unless play ends first"}, &MatchValues::duel_mean_s},
    MatchInputSpec{{"duel_push_share", "", kShare, "force of a duel, as a share of the largest force that the robot can hold in its direction before a wheel slides"}, &MatchValues::duel_push_share},
    MatchInputSpec{{"duel_angle", "rad", kAngle, "largest angle between a push and the robot's front, either way"}, &MatchValues::duel_angle_rad},
    MatchInputSpec{{"role_distance", "", kFactor, "distances of a defender in play, as a share of an attacker's; a keeper's are half of a defender's"}, &MatchValues::role_distance_share},
    MatchInputSpec{{"role_duels", "", base::Range::between(0.0, 4.0), "number of a defender's duels, as a share of an attacker's; a keeper has a fifth of a defender's"}, &MatchValues::role_duels_share},
    MatchInputSpec{{"role_zone", "", base::Range::between(0.1, 1.6), "factor on the size of a role's zone: 6 % of the field's length and 25 % of its width for a keeper, 32 % and 60 % for a defender"}, &MatchValues::role_zone_factor},
    MatchInputSpec{{"outside_distance", "", kFactor, "factor on distances outside play: 0.3 m at a free kick, 0.5 m to clear a ball placement, 0.7 m in a stop, 1 m to a kick-off, 2 m with the ball in its placement, half the field at half-time"}, &MatchValues::outside_distance_factor},
    MatchInputSpec{{"outside_speed", "", kFactor, "factor on the speed outside play: 1.5 m/s, but 1 m/s with the ball in its placement and at half-time; never above the rules' limit; at a free kick the robot drives as fast as it can"}, &MatchValues::outside_speed_factor},
};
// clang-format on
static_assert(kSpecs.size() == std::tuple_size_v<decltype(MatchInputs::parameters)>);

}  // namespace

std::span<const MatchInputSpec> match_input_specs() { return kSpecs; }

MatchValues MatchInputs::nominal() const {
  MatchValues values;
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    values.*kSpecs[i].value = parameters[i].value;
  }
  return values;
}

MatchValues MatchInputs::draw(base::Random& random) const {
  MatchValues values;
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    values.*kSpecs[i].value = parameters[i].quantile(random.uniform());
  }
  return values;
}

MatchInputs read_match_inputs(input::Reader& table) {
  MatchInputs inputs;
  constexpr std::array<std::string_view, 2> kDivisions{"A", "B"};
  inputs.division = table.choice("division", kDivisions, input::Need::required) == "B" ? Division::b : Division::a;
  if (const std::optional<std::string> role = table.choice("role", kRoleNames, input::Need::required)) {
    inputs.role = static_cast<Role>(std::ranges::find(kRoleNames, *role) - kRoleNames.begin());
  }
  inputs.overtime = table.flag("overtime", input::Need::optional).value_or(false);
  for (std::size_t i = 0; i < kSpecs.size(); ++i) {
    inputs.parameters[i] = table.parameter(kSpecs[i].spec, input::Need::required).value_or(base::ParameterValue{});
  }
  const MatchValues values = inputs.nominal();
  if (values.stop_shortest_s > values.stop_mean_s) {
    table.problem("stop_shortest", fmt::format("{} s is longer than stop_mean, {} s, which includes it; expected at most stop_mean",
                                               values.stop_shortest_s, values.stop_mean_s));
  }
  return inputs;
}

}  // namespace heatsoak::duty
