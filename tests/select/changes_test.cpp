// Changes of a robot, compared with the physically expected results.
#include "select/changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>

#include "select/evaluate.h"
#include "support/shipped.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

const ChangeEffect& of(const std::vector<ChangeEffect>& all, ChangedQuantity quantity) {
  return *std::ranges::find(all, quantity, &ChangeEffect::quantity);
}

class Changes : public testing::Test {
 protected:
  robot::Robot robot_ = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  motor::Motor motor_ = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
};

// Copper loss at steady state is proportional to the square of the torque. A gear of 1.25 reduces it, and its temperature rise, to 0.64.
// A cycle of 4 s on and 6 s off becomes 4 s and 9 s. At most, the rise falls to 10/13 times the ratio of the resistances at 67 and 80 °C,
// 0.957, that is by 0.264. The ripple of the winding does not fall.
TEST_F(Changes, gear_and_pauses_act_on_a_fixed_load) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const std::vector<ChangeEffect> all = effects_of_changes(robot_, duty, motor_, {}, 1, 0);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_GT(of(all, ChangedQuantity::gear_ratio).saved_K, 0.3 * 55.0);
  EXPECT_LT(of(all, ChangedQuantity::gear_ratio).saved_K, 0.5 * 55.0);
  EXPECT_GT(of(all, ChangedQuantity::pauses).saved_K, 0.10 * 55.0);
  EXPECT_LT(of(all, ChangedQuantity::pauses).saved_K, 0.264 * 55.0);
}

TEST_F(Changes, another_motor_is_named_only_if_it_passes) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const motor::Motor own = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  const std::vector<motor::Motor> others{own, motor_, motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml")};
  const std::vector<ChangeEffect> all = effects_of_changes(robot_, duty, own, others, 1, 0);
  const ChangeEffect& other = of(all, ChangedQuantity::motor);
  EXPECT_EQ(other.other_motor, "maxon_ecx_flat_42m_24v") << "it has the largest margin";
  EXPECT_GT(other.saved_K, 50.0);
  EXPECT_TRUE(other.is_deliverable);
  const std::vector<ChangeEffect> alone = effects_of_changes(robot_, duty, own, std::span(&own, 1), 1, 0);
  EXPECT_TRUE(std::ranges::none_of(alone, [](const ChangeEffect& each) { return each.quantity == ChangedQuantity::motor; }));
}

TEST_F(Changes, of_the_robot_come_before_another_motor) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const motor::Motor own = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  const motor::Motor other = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  const std::vector<ChangeEffect> all = effects_of_changes(robot_, duty, own, std::span(&other, 1), 1, 0);
  ASSERT_GT(all.size(), 1U);
  EXPECT_EQ(all.back().quantity, ChangedQuantity::motor);
  EXPECT_GT(all.back().saved_K, all.front().saved_K) << "although it helps most";
}

// At a tenth of the battery's voltage the speed cannot be reached. A higher gear ratio would need even more voltage.
TEST_F(Changes, a_motor_that_lacks_voltage_gets_a_lower_gear) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  robot::Robot weak = robot_;
  weak.battery.nominal_V = 0.1 * robot_.battery.nominal_V;
  const std::vector<ChangeEffect> all = effects_of_changes(weak, duty, motor_, {}, 1, 0);
  EXPECT_LT(of(all, ChangedQuantity::gear_ratio).factor, 1.0);
}

/// Counts how often a match is played.
class CountedMatch final : public duty::DutyShape {
 public:
  explicit CountedMatch(std::shared_ptr<const duty::DutyShape> match) : match_(std::move(match)) {}
  [[nodiscard]] std::vector<duty::WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const override {
    ++played;
    return match_->demand(robot, seed);
  }
  [[nodiscard]] bool depends_on_robot() const override { return true; }
  [[nodiscard]] bool has_unknowns() const override { return true; }
  mutable std::atomic<int> played = 0;

 private:
  std::shared_ptr<const duty::DutyShape> match_;
};

/// Changes for a match. Games take most of the time, so they are computed once for all tests of the process.
struct ChangesOfAMatch {
  ChangesOfAMatch() {
    for (const std::string_view id :
         {"maxon_ecx_flat_42m_24v", "nanotec_df45l024048_a2", "maxon_ecx_flat_32l_48v", "maxon_ecx_flat_42m_48v"}) {
      others.push_back(motor::read_motor(kSource / "motor_db" / (std::string(id) + ".toml")));
    }
    duty::Duty counted = duty;
    const auto match = std::make_shared<CountedMatch>(duty.shape_data);
    counted.shape_data = match;
    all = effects_of_changes(robot, counted, motor, others, 1, 0);
    played = match->played;
  }

  robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_b_match.toml");
  std::vector<motor::Motor> others;
  std::vector<ChangeEffect> all;
  int played = 0;
};

const ChangesOfAMatch& changes_of_a_match() {
  static const ChangesOfAMatch kOnce;
  return kOnce;
}

TEST_F(Changes, a_match_heats_less_with_less_mass_jerk_and_wheel) {
  const auto& [robot, motor, duty, others, all, played] = changes_of_a_match();
  EXPECT_EQ(all.size(), 9U);
  for (const ChangedQuantity each :
       {ChangedQuantity::mass, ChangedQuantity::wheel_radius, ChangedQuantity::gear_ratio, ChangedQuantity::pauses}) {
    EXPECT_GT(of(all, each).saved_K, 0.0) << name_of(each);
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].is_deliverable == all[i - 1].is_deliverable && all[i].other_motor.empty()) {
      EXPECT_LE(all[i].saved_K, all[i - 1].saved_K);
    }
  }
  const std::vector<ChangeEffect> again = effects_of_changes(robot, duty, motor, others, 1, 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].saved_K, again[i].saved_K) << "does not depend on threads";
  }
}

// Six changes act on the wheels' loads: acceleration, jerk, speed, yaw acceleration, mass and wheel radius.
TEST_F(Changes, games_are_played_again_only_for_changes_of_the_loads) { EXPECT_EQ(changes_of_a_match().played, kChangeGames * (1 + 6)); }

// Only a motor that can still have the largest margin is evaluated in all games; the result is that of all motors in all games.
TEST_F(Changes, the_best_other_motor_is_that_of_a_full_search) {
  const auto& [robot, motor, duty, others, all, played] = changes_of_a_match();
  std::string best;
  double most_K = -1e9;
  for (const motor::Motor& each : others) {
    double margin_K = 1e9;
    bool passes = true;
    for (int game = 0; game < kChangeGames; ++game) {
      const std::vector<duty::WheelDemand> wheels = duty.demand(robot, 1 + static_cast<std::uint64_t>(game));
      const MotorEvaluation result = evaluate(robot, duty, wheels, std::span(&each, 1), {.samples = 0}).front();
      margin_K = std::min(margin_K, nearest_margin_K(result));
      passes = passes && result.verdict == Verdict::pass;
    }
    if (passes && margin_K > most_K) {
      best = each.id;
      most_K = margin_K;
    }
  }
  EXPECT_EQ(of(all, ChangedQuantity::motor).other_motor, best);
}

}  // namespace
}  // namespace heatsoak::select
