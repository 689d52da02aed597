#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "duty/match/match_duty.h"
#include "support/source_folder.h"

namespace heatsoak::duty {
namespace {

const MatchInputs& division_a() {
  static const Duty kDuty = read_duty(kSource / "duty_profiles/division_a_match.toml");
  return dynamic_cast<const MatchDuty&>(*kDuty.shape_data).inputs();
}

robot::Robot twente() { return robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml"); }

double clock_s(const std::vector<MatchPhase>& game) {
  return std::accumulate(game.begin(), game.end(), 0.0, [](double sum_s, const MatchPhase& span) {
    return sum_s + (rule_of(span.phase).clock_runs ? span.duration_s : 0.0);
  });
}

TEST(Game, the_clock_runs_for_two_halves_exactly) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    base::Random random(seed, 0);
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
  base::Random random(1, 0);
  EXPECT_NEAR(clock_s(generate_game(Division::b, true, division_a().nominal(), random)), 900.0, 1e-9);
}

TEST(Game, a_division_b_free_kick_may_wait_ten_seconds_and_a_division_a_one_five) {
  for (const auto& [division, most_s] : {std::pair(Division::a, 5.0), std::pair(Division::b, 10.0)}) {
    double longest_s = 0.0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      base::Random random(seed, 0);
      for (const MatchPhase& span : generate_game(division, false, division_a().nominal(), random)) {
        longest_s = span.phase == Phase::free_kick ? std::max(longest_s, span.duration_s) : longest_s;
      }
    }
    EXPECT_LE(longest_s, most_s);
    EXPECT_GT(longest_s, 0.9 * most_s);
  }
}

/// Statistics over many games.
struct Counted {
  std::array<double, kPhaseNames.size()> time_s{};
  std::array<int, kPhaseNames.size()> spans{};
  double mean_s(Phase phase) const { return time_s[static_cast<std::size_t>(phase)] / count(phase); }
  double count(Phase phase) const { return spans[static_cast<std::size_t>(phase)]; }
};

constexpr int kGames = 4000;

Counted many_games(Division division, const MatchValues& values, bool overtime = false) {
  Counted counted;
  for (std::uint64_t seed = 0; seed < kGames; ++seed) {
    base::Random random(seed, 0);
    for (const MatchPhase& span : generate_game(division, overtime, values, random)) {
      counted.time_s[static_cast<std::size_t>(span.phase)] += span.duration_s;
      ++counted.spans[static_cast<std::size_t>(span.phase)];
    }
  }
  return counted;
}

// Over many games the observed mean must equal the input.
TEST(Game, lengths_and_numbers_have_the_means_of_their_inputs) {
  constexpr double kClose = 0.02;
  const auto expect = [](double seen, double wanted, const char* what) { EXPECT_NEAR(seen, wanted, kClose * wanted) << what; };
  for (const Division division : {Division::a, Division::b}) {
    for (const double running_mean_s : {8.0, 15.0, 30.0}) {
      MatchValues values = division_a().nominal();
      values.running_mean_s = running_mean_s;
      const Counted seen = many_games(division, values);
      // The end of a half truncates a segment but does not change the number of interruptions per time of play.
      expect(seen.time_s[static_cast<std::size_t>(Phase::running)] / seen.count(Phase::free_kick), values.running_mean_s, "running_mean");
      expect(seen.mean_s(Phase::stop), values.stop_mean_s, "stop_mean");
      expect(seen.count(Phase::ball_placement) / seen.count(Phase::free_kick), values.placement_share, "placement_share");
      expect(seen.mean_s(Phase::ball_placement), values.placement_mean_s, "placement_mean");
      expect(seen.count(Phase::halt) / kGames / 2.0, values.halt_count, "halt_count");
      expect(seen.mean_s(Phase::halt), values.halt_mean_s, "halt_mean");
      expect(seen.count(Phase::timeout) / kGames, values.timeout_count, "timeout_count");
    }
  }
}

TEST(Game, means_hold_at_the_ends_of_their_ranges) {
  MatchValues values = division_a().nominal();
  values.running_mean_s = 300.0;  // many halves have no interruption
  values.stop_mean_s = 1.5;       // shorter than the shortest stop
  values.placement_mean_s = 20.0;
  values.halt_count = 5.0;
  values.timeout_count = 6.0;
  const Counted seen = many_games(Division::a, values, true);
  EXPECT_NEAR(seen.mean_s(Phase::stop), 1.5, 1e-9);
  EXPECT_NEAR(seen.mean_s(Phase::ball_placement), 20.0, 0.4);
  EXPECT_NEAR(seen.count(Phase::halt) / kGames, 3.0 * 5.0, 0.3);  // overtime is half as long as the two halves
  EXPECT_NEAR(seen.count(Phase::timeout) / kGames, 1.5 * 6.0, 0.2);
}

struct CommandInPhase {
  Phase phase = Phase::halt;
  FieldPose from;
  MotionCommand command;
};

/// Commands of one game for a robot that drives at 1.2 m/s.
std::vector<CommandInPhase> commands(const MatchInputs& inputs, const MatchValues& values, std::uint64_t seed) {
  constexpr double kSpeed_m_per_s = 1.2;
  base::Random random(seed, 0);
  const std::vector<MatchPhase> game = generate_game(inputs.division, inputs.overtime, values, random);
  Behaviour behaviour(inputs, values, random);
  std::vector<CommandInPhase> all;
  FieldPose at;
  for (const MatchPhase& span : game) {
    for (double into_s = 0.0; span.duration_s - into_s > 5e-4; into_s += std::max(1e-3, all.back().command.duration_s)) {
      const MotionCommand command = behaviour.next(span.phase, into_s, span.duration_s - into_s, at);
      all.push_back({span.phase, at, command});
      if (!command.stand) {
        const double way_m = std::hypot(command.x_m - at.x_m, command.y_m - at.y_m);
        const double done = std::min(1.0, command.duration_s * kSpeed_m_per_s / std::max(way_m, 1e-6));
        at = {std::lerp(at.x_m, command.x_m, done), std::lerp(at.y_m, command.y_m, done), command.yaw_rad};
      }
    }
  }
  return all;
}

TEST(Behaviour, distances_and_duels_are_those_of_the_inputs) {
  const MatchValues values = division_a().nominal();
  struct Asked {
    Role role;
    double distance_m;
    double duels_per_min;
  };
  for (const auto& [role, distance_m, duels_per_min] :
       {Asked{Role::attacker, values.distance_median_m, values.duels_per_min},
        Asked{Role::defender, values.distance_median_m * values.role_distance_share, values.duels_per_min * values.role_duels_share}}) {
    MatchInputs inputs = division_a();
    inputs.role = role;
    std::vector<double> ways_m;
    double play_s = 0.0;
    int duels = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      for (const auto& [phase, from, command] : commands(inputs, values, seed)) {
        if (phase != Phase::running) {
          continue;
        }
        play_s += command.duration_s;
        duels += command.duel ? 1 : 0;
        if (!command.duel) {
          ways_m.push_back(std::hypot(command.x_m - from.x_m, command.y_m - from.y_m));
        }
      }
    }
    EXPECT_NEAR(60.0 * duels / play_s, duels_per_min, 0.02 * duels_per_min);
    std::ranges::nth_element(ways_m, ways_m.begin() + static_cast<std::ptrdiff_t>(ways_m.size() / 2));
    EXPECT_NEAR(ways_m[ways_m.size() / 2], distance_m, 0.02 * distance_m);
  }
}

// Each input must change the commands of a robot.
TEST(Behaviour, every_input_matters) {
  MatchInputs inputs = division_a();
  inputs.role = Role::defender;
  const auto sum = [&](const MatchInputs& of) {
    double total = 0.0;
    for (const auto& [phase, from, command] : commands(of, of.nominal(), 1)) {
      const double speed_m_per_s = std::isfinite(command.speed_limit_m_per_s) ? command.speed_limit_m_per_s : 0.0;
      total += command.duration_s + command.x_m + command.y_m + command.yaw_rad + command.push_direction_rad + command.push_share +
               speed_m_per_s;
    }
    return total;
  };
  for (std::size_t i = 0; i < inputs.parameters.size(); ++i) {
    const std::string_view key = match_input_specs()[i].spec.key;
    ASSERT_TRUE(inputs.parameters[i].spread) << key << " has no range";
    MatchInputs other = inputs;
    other.parameters[i].value = inputs.parameters[i].spread->low;
    if (key != "aggressiveness") {  // only the planner uses it
      EXPECT_NE(sum(other), sum(inputs)) << key;
    }
  }
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
  std::vector<double> current_squared_A2_s = std::vector<double>(4, 0.0);  ///< one value per motor, accumulated step by step
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
    EXPECT_LE(seen.fastest_m_per_s, 2.0 * 1.005);  // limit is a circle, which combined axes exceed by about 0.2 %
    EXPECT_LT(seen.farthest_m, 0.3);
  }
}

TEST(Match, duels_push_at_a_stand) {
  const Seen seen = watch(division_a(), 1);
  EXPECT_GT(seen.duel_s, 5.0);
  EXPECT_EQ(seen.duel_speed_rad_per_s, 0.0);
}

// In a duel the robot pushes with the given share of the largest force that the ground transmits in that direction, without turning.
TEST(Match, a_duel_pushes_with_its_share_of_the_grip) {
  motor::MotorValues no_rotor;
  no_rotor.rotor_inertia_kg_m2 = 0.0;
  const robot::BodyConfig body = robot::make_body(twente(), no_rotor);
  const std::size_t input = static_cast<std::size_t>(
      std::ranges::find(match_input_specs(), "duel_push_share", [](const MatchInputSpec& each) { return each.spec.key; }) -
      match_input_specs().begin());
  double before_Nm = 0.0;
  for (const double share : {0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}) {
    MatchInputs inputs = division_a();
    inputs.parameters.at(input).value = share;
    double largest_Nm = 0.0;
    int duels = 0;
    play_match(inputs, inputs.nominal(), twente(), 1, Planner::jerk_limited, 0.25, [&](const MatchMoment& now) {
      if (!now.duel) {
        return;
      }
      ++duels;
      const robot::Wrench push = robot::wrench_of_rolling_forces(body.kinematics, now.wheels->rolling_force_N);
      const double direction_rad = std::atan2(push.y_N, push.x_N);
      const double most_N = robot::largest_push_N(body, direction_rad, body.weight.center_of_gravity_height_m);
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

// The means of a bin must give ∫I² of a motor with drag exactly, whatever moments were merged.
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
  const robot::Robot robot = twente();
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

// Drawn games use steps four times as long and a different course. Over many games their heat must be the same.
TEST(Match, drawn_games_have_the_heat_of_games_in_finer_steps) {
  const auto heat = [](std::uint64_t seed, double step_s) {
    double sum_Nm2_s = 0.0;
    for (const WheelDemand& wheel :
         play_match(division_a(), division_a().nominal(), twente(), seed, Planner::jerk_limited, kBin_s, {}, step_s).wheels) {
      for (const LoadBin& bin : wheel.bins) {
        sum_Nm2_s += bin.torque_rms_Nm * bin.torque_rms_Nm * bin.duration_s;
      }
    }
    return sum_Nm2_s;
  };
  double fine_Nm2_s = 0.0;
  double coarse_Nm2_s = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    fine_Nm2_s += heat(seed, kGameStep_s);
    coarse_Nm2_s += heat(seed, kDrawnGameStep_s);
  }
  EXPECT_NEAR(coarse_Nm2_s / fine_Nm2_s, 1.0, 0.02);
}

// The script for other driving methods must cover the game without gaps, phase by phase.
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

// Draws are different games with different inputs, each reproducible.
TEST(Match, draws_spread_the_demand) {
  const robot::Robot robot = twente();
  const MatchDuty duty(division_a());
  ASSERT_TRUE(duty.has_unknowns());
  const auto rms_Nm = [](const WheelDemand& wheel) {
    double sum_Nm2_s = 0.0;
    for (const LoadBin& bin : wheel.bins) {
      sum_Nm2_s += bin.torque_rms_Nm * bin.torque_rms_Nm * bin.duration_s;
    }
    return std::sqrt(sum_Nm2_s / wheel.duration_s());
  };
  std::vector<double> drawn_Nm;
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    drawn_Nm.push_back(rms_Nm(duty.draw(robot, 1, draw)));
  }
  EXPECT_EQ(rms_Nm(duty.draw(robot, 1, 3)), drawn_Nm[3]);
  EXPECT_NE(rms_Nm(duty.draw(robot, 2, 3)), drawn_Nm[3]);
  const auto [least, most] = std::ranges::minmax(drawn_Nm);
  EXPECT_GT(most - least, 0.1 * rms_Nm(hardest(duty.demand(robot, 1))));
}

TEST(Match, the_hardest_wheel_alone_has_the_same_demand) {
  const MatchInputs inputs = division_a();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const WheelDemand of_all =
        hardest(play_match(inputs, inputs.nominal(), twente(), seed, Planner::jerk_limited, kBin_s, {}, kDrawnGameStep_s).wheels);
    const WheelDemand alone =
        hardest_wheel_of_match(inputs, inputs.nominal(), twente(), seed, Planner::jerk_limited, kBin_s, kDrawnGameStep_s);
    EXPECT_EQ(alone.wheel, of_all.wheel);
    EXPECT_EQ(alone.slip_share, of_all.slip_share);
    ASSERT_EQ(alone.bins.size(), of_all.bins.size());
    ASSERT_EQ(alone.points.size(), of_all.points.size());
    for (std::size_t i = 0; i < alone.bins.size(); ++i) {
      EXPECT_EQ(alone.bins[i].torque_rms_Nm, of_all.bins[i].torque_rms_Nm);
      EXPECT_EQ(alone.bins[i].power_mean_W, of_all.bins[i].power_mean_W);
    }
    for (std::size_t i = 0; i < alone.points.size(); ++i) {
      EXPECT_EQ(alone.points[i].time_s, of_all.points[i].time_s);
    }
  }
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

TEST(Match, a_robot_without_values_for_motion_is_refused_by_name) {
  robot::Robot robot = twente();
  robot.body.yaw_inertia_kg_m2.reset();
  robot.limits.jerk_m_per_s3.reset();
  robot.friction.wheel_torque_Nm.reset();
  try {
    play_match(division_a(), division_a().nominal(), robot, 1, Planner::jerk_limited);
    FAIL() << "is not refused";
  } catch (const base::Failure& failure) {
    std::vector<std::string> keys;
    std::ranges::transform(failure.diagnostics(), std::back_inserter(keys), &base::Diagnostic::key);
    EXPECT_THAT(keys, testing::UnorderedElementsAre("body.yaw_inertia", "limits.jerk", "friction.wheel_torque"));
  }
}

TEST(Match, limits_that_the_planner_cannot_hold_are_said_in_words) {
  robot::Robot robot = twente();
  robot.limits.jerk_m_per_s3 = 1e12;
  try {
    (void)play_match(division_a(), division_a().nominal(), robot, 1, Planner::jerk_limited);
    FAIL() << "played";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::numerics_failed);
    EXPECT_NE(std::string_view(failure.what()).find("limits and distances are too many orders of magnitude apart"), std::string_view::npos)
        << failure.what();
    EXPECT_NE(std::string_view(failure.what()).find("[limits]"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace heatsoak::duty
