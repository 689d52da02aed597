// Which motors a seed has.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "motor_case.h"

namespace heatsoak::suite {
namespace {

constexpr int kNulls = 40;
constexpr int kPairs = 16;
constexpr int kEightBodies = 40;
constexpr int kEightBodiesWithEffect = 10;

class Planner {
 public:
  explicit Planner(std::uint64_t seed) : random_(seed, "plan") {}

  /// Adds a motor. Families alternate, and every second pair of motors has Ornstein-Uhlenbeck heat.
  CasePlan& add(const std::string& group) {
    static constexpr std::array<UnknownHeat, 3> kOthers{UnknownHeat::kSteps, UnknownHeat::kSines, UnknownHeat::kDrift};
    const int number = group == group_ ? number_ + 1 : 1;
    group_ = group;
    number_ = number;
    CasePlan plan{.id = fmt::format("{}_{:02}", group, number),
                  .group = group,
                  .family = number % 2 == 1 ? &small_family() : &large_family(),
                  .has_eight_bodies = group == "eight"};
    if ((number / 2) % 2 == 1) {
      plan.unknown_heat = kOthers[random_.index(kOthers.size())];
    }
    cases_.push_back(plan);
    return cases_.back();
  }

  double strength() { return random_.log_uniform(0.6, 2.2); }
  Random& random() { return random_; }
  std::vector<CasePlan> done() { return std::move(cases_); }

 private:
  Random random_;
  std::string group_;
  int number_ = 0;
  std::vector<CasePlan> cases_;
};

/// Effects that are invisible in one range of temperatures or nearly equal to the no-load loss. They occur once, the others in both
/// families.
bool is_nearly_hidden(const EffectKind& kind) {
  static const std::set<std::string, std::less<>> kIds{"natural_convection", "radiation", "iron_loss_hysteresis"};
  return kIds.contains(kind.id);
}

/// Family of the i-th kind; each kind meets the other family in the second round.
const Family* family_of(std::size_t kind, std::size_t round) { return (kind + round) % 2 == 0 ? &small_family() : &large_family(); }

void add_singles(Planner& planner) {
  for (std::size_t round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < catalogue_effects().size(); ++i) {
      const EffectKind& kind = catalogue_effects()[i];
      if (round == 0 || !is_nearly_hidden(kind)) {
        CasePlan& plan = planner.add("single");
        plan.family = family_of(i, round);
        plan.effects = {{&kind, planner.strength()}};
      }
    }
  }
}

const EffectKind& drawn_kind(Random& random) {
  for (;;) {
    const EffectKind& kind = catalogue_effects()[random.index(catalogue_effects().size())];
    if (!is_nearly_hidden(kind)) {
      return kind;
    }
  }
}

bool is_sensor_error(const EffectKind& kind) { return kind.id.starts_with("sensor_"); }

void add_pairs(Planner& planner) {
  for (int i = 0; i < kPairs; ++i) {
    const EffectKind& first = drawn_kind(planner.random());
    const EffectKind* second = &first;
    while (second->family == first.family || (is_sensor_error(first) && is_sensor_error(*second))) {
      second = &drawn_kind(planner.random());
    }
    const double first_strength = planner.random().log_uniform(1.0, 2.2);
    planner.add("pair").effects = {{&first, first_strength}, {second, planner.random().log_uniform(1.0, 2.2)}};
  }
}

void add_outside(Planner& planner) {
  for (std::size_t round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < outside_effects().size(); ++i) {
      CasePlan& plan = planner.add("outside");
      plan.family = family_of(i, round);
      plan.effects = {{&outside_effects()[i], planner.random().log_uniform(0.7, 1.8)}};
    }
  }
}

void add_eight(Planner& planner) {
  for (int i = 0; i < kEightBodies; ++i) {
    CasePlan& plan = planner.add("eight");
    if (i >= kEightBodies - kEightBodiesWithEffect) {
      const EffectKind* kind = &drawn_kind(planner.random());
      while (is_sensor_error(*kind) || kind->id == "third_node" || kind->id == "enclosure_warm_up") {
        kind = &drawn_kind(planner.random());
      }
      plan.effects = {{kind, planner.strength()}};
    }
  }
}

}  // namespace

std::vector<CasePlan> planned_cases(std::uint64_t seed) {
  Planner planner(seed);
  for (int i = 0; i < kNulls; ++i) {
    planner.add("null");
  }
  add_singles(planner);
  add_pairs(planner);
  add_outside(planner);
  add_eight(planner);
  return planner.done();
}

}  // namespace heatsoak::suite
