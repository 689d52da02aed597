#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "duty/match/match_duty.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

const MatchInputs& division_a() {
  static const Duty kDuty = read_duty(kSource / "duty_profiles/division_a_match.toml");
  return dynamic_cast<const MatchDuty&>(*kDuty.shape_data).inputs();
}

Robot twente() { return read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml"); }

double clock_s(const std::vector<MatchPhase>& game) {
  return std::accumulate(game.begin(), game.end(), 0.0, [](double sum_s, const MatchPhase& span) {
    return sum_s + (rule_of(span.phase).clock_runs ? span.duration_s : 0.0);
  });
}

TEST(Game, the_clock_runs_for_two_halves_exactly) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 0);
    const std::vector<MatchPhase> game = generate_game(Division::a, false, division_a().nominal(), random);
    EXPECT_NEAR(clock_s(game), 600.0, 1e-9);
    for (const MatchPhase& span : game) {
      EXPECT_GE(span.duration_s, 0.0);
      if (span.phase == Phase::ball_placement) {
        EXPECT_LE(span.duration_s, 30.0);
      }
    }
  }
}

TEST(Game, overtime_adds_two_short_halves) {
  Random random(1, 0);
  EXPECT_NEAR(clock_s(generate_game(Division::b, true, division_a().nominal(), random)), 900.0, 1e-9);
}

TEST(Game, a_division_b_free_kick_may_wait_ten_seconds_and_a_division_a_one_five) {
  for (const auto& [division, most_s] : {std::pair(Division::a, 5.0), std::pair(Division::b, 10.0)}) {
    double longest_s = 0.0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Random random(seed, 0);
      for (const MatchPhase& span : generate_game(division, false, division_a().nominal(), random)) {
        longest_s = span.phase == Phase::free_kick ? std::max(longest_s, span.duration_s) : longest_s;
      }
    }
    EXPECT_LE(longest_s, most_s);
    EXPECT_GT(longest_s, 0.9 * most_s);
  }
}

// Over many games an exponential stretch of play has the mean that the input names; the half's end cuts some.
TEST(Game, stretches_of_play_have_the_mean_of_the_input) {
  double sum_s = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed, 0);
    for (const MatchPhase& span : generate_game(Division::a, false, division_a().nominal(), random)) {
      if (span.phase == Phase::running) {
        sum_s += span.duration_s;
        ++count;
      }
    }
  }
  EXPECT_NEAR(sum_s / count, division_a().nominal().running_mean_s, 0.08 * division_a().nominal().running_mean_s);
}

struct Seen {
  double fastest_in_stop_m_per_s = 0.0;
  double moved_in_halt_m_per_s = 0.0;
  double fastest_m_per_s = 0.0;
  double duel_s = 0.0;
  double duel_torque_Nm = 0.0;
  double duel_speed_rad_per_s = 0.0;
  double farthest_m = 0.0;
  std::vector<double> torque_squared_Nm2_s = std::vector<double>(4, 0.0);
  std::vector<double> current_squared_A2_s = std::vector<double>(4, 0.0);  ///< of a motor, step by step
};

constexpr double kTorqueConstant_Nm_per_A = 0.0328;
constexpr double kDrag_Nm = 0.0082;

Seen watch(const MatchInputs& inputs, std::uint64_t seed, MatchLoad* load = nullptr) {
  Seen seen;
  double into_s = 0.0;
  Phase before = Phase::halt;
  const MatchLoad result = play_match(inputs, inputs.nominal(), twente(), seed, Planner::jerk_limited, 0.25, [&](const MatchMoment& now) {
    into_s = now.phase == before ? into_s + now.step_s : 0.0;
    before = now.phase;
    const double speed_m_per_s = std::hypot(now.velocity_global.x_m_per_s, now.velocity_global.y_m_per_s);
    seen.fastest_m_per_s = std::max(seen.fastest_m_per_s, speed_m_per_s);
    seen.farthest_m = std::max({seen.farthest_m, std::abs(now.pose.x_m) - 6.0, std::abs(now.pose.y_m) - 4.5});
    if (now.phase == Phase::stop && into_s > 2.0) {
      seen.fastest_in_stop_m_per_s = std::max(seen.fastest_in_stop_m_per_s, speed_m_per_s);
    }
    if (now.phase == Phase::halt && into_s > 2.0) {
      seen.moved_in_halt_m_per_s = std::max(seen.moved_in_halt_m_per_s, speed_m_per_s);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const double torque_Nm = now.wheels->torque_Nm[i];
      const double speed_rad_per_s = now.wheels->speed_rad_per_s[i];
      const double current_A = (torque_Nm + kDrag_Nm * (speed_rad_per_s > kStandstill_rad_per_s    ? 1.0
                                                        : speed_rad_per_s < -kStandstill_rad_per_s ? -1.0
                                                                                                   : 0.0)) /
                               kTorqueConstant_Nm_per_A;
      seen.torque_squared_Nm2_s[i] += torque_Nm * torque_Nm * now.step_s;
      seen.current_squared_A2_s[i] += current_A * current_A * now.step_s;
      if (now.duel) {
        seen.duel_torque_Nm = std::max(seen.duel_torque_Nm, std::abs(torque_Nm));
        seen.duel_speed_rad_per_s = std::max(seen.duel_speed_rad_per_s, std::abs(speed_rad_per_s));
      }
    }
    seen.duel_s += now.duel ? now.step_s : 0.0;
  });
  if (load) {
    *load = result;
  }
  return seen;
}

TEST(Match, keeps_the_rules_and_the_robot_s_limits) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Seen seen = watch(division_a(), seed);
    EXPECT_LE(seen.fastest_in_stop_m_per_s, 1.5 + 1e-9);
    EXPECT_LE(seen.moved_in_halt_m_per_s, 1e-9);
    EXPECT_LE(seen.fastest_m_per_s, 2.0 * 1.005);  // a circle, which joined axes leave by some 0.2 %
    EXPECT_LT(seen.farthest_m, 0.3);
  }
}

TEST(Match, duels_push_at_a_stand) {
  const Seen seen = watch(division_a(), 1);
  EXPECT_GT(seen.duel_s, 5.0);
  EXPECT_EQ(seen.duel_speed_rad_per_s, 0.0);
}

// What the ground passes on in a duel is what is asked: the share of the largest push there is in that direction, and no turn.
TEST(Match, a_duel_pushes_with_its_share_of_the_grip) {
  MotorValues no_rotor;
  no_rotor.rotor_inertia_kg_m2 = 0.0;
  const BodyConfig body = make_body(twente(), no_rotor);
  const std::size_t input = static_cast<std::size_t>(
      std::ranges::find(match_input_specs(), "duel_push_share", [](const MatchInputSpec& each) { return each.spec.key; }) -
      match_input_specs().begin());
  double before_Nm = 0.0;
  for (const double share : {0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}) {
    MatchInputs inputs = division_a();
    inputs.figures.at(input).value = share;
    double largest_Nm = 0.0;
    int duels = 0;
    play_match(inputs, inputs.nominal(), twente(), 1, Planner::jerk_limited, 0.25, [&](const MatchMoment& now) {
      if (!now.duel) {
        return;
      }
      ++duels;
      const Wrench push = wrench_of_rolling_forces(body.kinematics, now.wheels->rolling_force_N);
      const double direction_rad = std::atan2(push.y_N, push.x_N);
      const double most_N = largest_push_N(body, direction_rad, body.weight.center_of_gravity_height_m);
      EXPECT_NEAR(std::hypot(push.x_N, push.y_N), share * most_N, 1e-6 * most_N);
      EXPECT_NEAR(push.yaw_Nm, 0.0, 1e-6);
      EXPECT_NEAR(std::hypot(now.wheels->untransmitted.x_N, now.wheels->untransmitted.y_N), 0.0, 1e-6);
      for (std::size_t i = 0; i < 4; ++i) {
        largest_Nm = std::max(largest_Nm, std::abs(now.wheels->torque_Nm[i]));
      }
    });
    EXPECT_GT(duels, 3);
    EXPECT_GT(largest_Nm, 1.05 * before_Nm) << share;
    before_Nm = largest_Nm;
  }
}

// The means of a bin give ∫I² of a motor with drag exactly, whatever moments were merged.
TEST(Match, bins_conserve_the_heat_of_every_motor) {
  MatchLoad load;
  const Seen seen = watch(division_a(), 3, &load);
  ASSERT_EQ(load.wheels.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    double binned_A2_s = 0.0;
    double points_s = 0.0;
    for (const LoadBin& bin : load.wheels[i].bins) {
      binned_A2_s +=
          bin.duration_s *
          (bin.torque_rms_Nm * bin.torque_rms_Nm + 2.0 * kDrag_Nm * bin.torque_along_motion_Nm + kDrag_Nm * kDrag_Nm * bin.moving_share) /
          (kTorqueConstant_Nm_per_A * kTorqueConstant_Nm_per_A);
    }
    for (const LoadPoint& point : load.wheels[i].points) {
      points_s += point.time_s;
    }
    EXPECT_NEAR(binned_A2_s / seen.current_squared_A2_s[i], 1.0, 1e-10);
    EXPECT_NEAR(load.wheels[i].duration_s(), load.duration_s, 1e-6);
    EXPECT_NEAR(points_s, load.duration_s, 1e-6);
  }
}

TEST(Match, same_seed_same_demand_and_another_seed_another) {
  const Robot robot = twente();
  const auto rms = [&](std::uint64_t seed) {
    std::vector<double> all;
    const MatchLoad load = play_match(division_a(), division_a().nominal(), robot, seed, Planner::jerk_limited);
    for (const LoadBin& bin : load.wheels[0].bins) {
      all.push_back(bin.torque_rms_Nm);
    }
    return all;
  };
  const std::vector<double> one = rms(7);
  EXPECT_EQ(one, rms(7));
  EXPECT_NE(one, rms(8));
}

// The script is what another way of driving is asked: it covers the game without gaps, phase by phase.
TEST(Match, the_script_is_the_game) {
  const MatchLoad load = play_match(division_a(), division_a().nominal(), twente(), 4, Planner::jerk_limited);
  std::array<double, kPhaseNames.size()> time_s{};
  ASSERT_EQ(load.script.front().time_s, 0.0);
  for (std::size_t i = 0; i < load.script.size(); ++i) {
    const double end_s = i + 1 < load.script.size() ? load.script[i + 1].time_s : load.duration_s;
    EXPECT_GE(end_s, load.script[i].time_s);
    time_s[static_cast<std::size_t>(load.script[i].phase)] += end_s - load.script[i].time_s;
  }
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    EXPECT_NEAR(time_s[i], load.phases[i].time_s, 1e-6);
  }
}

// Draws are other games with other inputs, each the same whenever it is drawn.
TEST(Match, draws_spread_the_demand) {
  const Robot robot = twente();
  const MatchDuty duty(division_a());
  ASSERT_TRUE(duty.has_unknowns());
  const auto rms_Nm = [](const std::vector<WheelDemand>& wheels) {
    double sum_Nm2_s = 0.0;
    for (const LoadBin& bin : wheels[2].bins) {
      sum_Nm2_s += bin.torque_rms_Nm * bin.torque_rms_Nm * bin.duration_s;
    }
    return std::sqrt(sum_Nm2_s / wheels[2].duration_s());
  };
  std::vector<double> drawn_Nm;
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    drawn_Nm.push_back(rms_Nm(duty.draw(robot, 1, draw)));
  }
  EXPECT_EQ(rms_Nm(duty.draw(robot, 1, 3)), drawn_Nm[3]);
  EXPECT_NE(rms_Nm(duty.draw(robot, 2, 3)), drawn_Nm[3]);
  const auto [least, most] = std::ranges::minmax(drawn_Nm);
  EXPECT_GT(most - least, 0.1 * rms_Nm(duty.demand(robot, 1)));
}

TEST(Match, a_keeper_works_less_than_an_attacker) {
  MatchInputs keeper = division_a();
  keeper.role = Role::keeper;
  double attacker_Nm2_s = 0.0;
  double keeper_Nm2_s = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    attacker_Nm2_s += watch(division_a(), seed).torque_squared_Nm2_s[0];
    keeper_Nm2_s += watch(keeper, seed).torque_squared_Nm2_s[0];
  }
  EXPECT_LT(keeper_Nm2_s, attacker_Nm2_s);
}

TEST(Match, a_robot_without_figures_for_motion_is_refused_by_name) {
  Robot robot = twente();
  robot.yaw_inertia_kg_m2 = kAbsent;
  EXPECT_THROW(play_match(division_a(), division_a().nominal(), robot, 1, Planner::jerk_limited), Failure);
}

TEST(Match, limits_that_the_planner_cannot_hold_are_said_in_words) {
  Robot robot = twente();
  robot.jerk_limit_m_per_s3 = 1e12;
  try {
    (void)play_match(division_a(), division_a().nominal(), robot, 1, Planner::jerk_limited);
    FAIL() << "played";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::numerics_failed);
    EXPECT_NE(std::string_view(failure.what()).find("limits and distances are too many orders of magnitude apart"), std::string_view::npos)
        << failure.what();
    EXPECT_NE(std::string_view(failure.what()).find("[limits]"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace heatsoak
