#include "duty/game_to_demand.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "duty/motion.h"
#include "duty/recorded_game.h"

namespace heatsoak::duty {
namespace {

constexpr double kRate_Hz = 1000.0;
/// Returns the detection rate of the robot if it is too low, otherwise nothing.
std::optional<double> low_sight_rate_Hz(const ImportReport& report, const RobotName& name) {
  const auto robot = std::ranges::find(report.robots, name, &RobotSummary::robot);
  if (robot == report.robots.end() || !(static_cast<double>(robot->points) < kFewestSights_Hz * robot->seen_s)) {
    return std::nullopt;
  }
  return static_cast<double>(robot->points) / robot->seen_s;
}

/// Returns the requested robot or, if `player` is empty, the one with the largest ∫a²; nothing if the log has no robots.
std::optional<RobotName> choose(const ImportReport& survey, const std::string& player, const std::filesystem::path& log) {
  std::vector<std::string> known;
  for (const RobotSummary& each : survey.robots) {
    known.push_back(to_string(each.robot));
    if (known.back() == player) {
      return each.robot;
    }
  }
  if (!player.empty() && !known.empty()) {
    throw GameNotUsable(base::ExitCode::bad_input,
                        fmt::format("{}: there is no robot '{}'{}; the log has {}", log.string(), player, base::did_you_mean(player, known),
                                    fmt::join(known, ", ")),
                        {.log = survey});
  }
  const auto busiest = std::ranges::max_element(survey.robots, {}, &RobotSummary::effort_m2_per_s3);
  return busiest == survey.robots.end() ? std::nullopt : std::optional(busiest->robot);
}

/// Demand of the wheels, with the times without detection and over the grip.
struct WheelLoads {
  std::vector<WheelDemand> wheels;
  double slip_s = 0.0;    ///< time in which the ground cannot transmit the forces
  double unseen_s = 0.0;  ///< time without detection, counted as standstill
  int jumps = 0;          ///< clock jumps, which are omitted
};

WheelLoads loads_of(const MotionTrack& motion, const robot::Robot& robot, double bin_s, const GameObserver& observer) {
  motor::MotorValues no_rotor;
  no_rotor.rotor_inertia_kg_m2 = 0.0;
  const robot::BodyConfig body = robot::make_body(robot, no_rotor);
  std::vector<DemandGatherer> gatherers;
  for (int wheel = 0; wheel < body.kinematics.wheel_count; ++wheel) {
    gatherers.emplace_back(fmt::format("wheel {}", wheel + 1), bin_s,
                           DemandGatherer::Grid{.torque_step_Nm = 0.002, .speed_step_rad_per_s = 3.0});
  }
  WheelLoads loads;
  const auto add = [&](double duration_s, const robot::WheelDemands& wheels) {
    for (std::size_t i = 0; i < gatherers.size(); ++i) {
      gatherers[i].add(duration_s, wheels.torque_Nm[i], wheels.speed_rad_per_s[i]);
    }
    if (observer) {
      observer(duration_s, wheels);
    }
  };
  double time_s = motion.segments().front().front().time_s;
  motion.for_each(kRate_Hz, [&](const Motion& at, std::size_t /*segment*/) {
    if (const double gap_s = at.time_s - time_s; gap_s > kLongestAbsence_s) {
      ++loads.jumps;
    } else if (gap_s > 2.0 / kRate_Hz) {
      loads.unseen_s += gap_s;
      add(gap_s, {});
    }
    time_s = at.time_s;
    const robot::BodyMotion local =
        robot::local_motion(body, {at.x_m, at.y_m, at.yaw_rad}, {at.velocity_x_m_per_s, at.velocity_y_m_per_s, at.yaw_rate_rad_per_s},
                            {at.acceleration_x_m_per_s2, at.acceleration_y_m_per_s2, at.yaw_acceleration_rad_per_s2});
    const robot::WheelDemands wheels = robot::inverse_dynamics(body, local);
    loads.slip_s += wheels.transmitted_share < 1.0 ? 1.0 / kRate_Hz : 0.0;
    add(1.0 / kRate_Hz, wheels);
  });
  for (DemandGatherer& each : gatherers) {
    loads.wheels.push_back(each.finish());
    loads.wheels.back().slip_share = loads.slip_s / loads.wheels.back().duration_s();
  }
  return loads;
}

const std::string kReading = "reading the log";
const std::string kLoads = "computing the loads of the wheels";

/// Begins a pass over the file; the result takes the share that has been read.
std::function<void(double)> reading(const base::JobProgress& progress) {
  if (!progress) {
    return {};
  }
  constexpr std::size_t kWhole = 1'000'000;
  return [report = progress.begin(kReading)](double share) {
    report(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(kWhole)), kWhole);
  };
}

}  // namespace

GameDemand demand_of_game(const std::filesystem::path& log, const std::string& player, const robot::Robot& robot, double bin_s,
                          const GameObserver& observer, const base::JobProgress& progress) {
  // Expected duration of one pass, as long as nothing has been measured.
  constexpr double kPass_s = 2.0;
  progress.expect({{kReading, kPass_s}, {kReading, kPass_s}, {kLoads, 0.5 * kPass_s}});
  ImportOptions survey;
  survey.most_points = 0;
  survey.progress = reading(progress);
  const RecordedGame first = import_game(log, survey);
  GameDemand result;
  result.log = first.report;
  const std::optional<RobotName> name = choose(first.report, player, log);
  if (!name) {
    return result;
  }
  result.player = to_string(*name);
  ImportOptions one;
  one.robot = name;
  one.progress = reading(progress);
  const RecordedGame game = import_game(log, one);
  if (game.tracks.empty() || game.tracks.front().segments.empty()) {
    return result;
  }
  // The second pass knows up to when points of this robot were kept.
  result.log.full_at_s = game.report.full_at_s;
  progress.begin(kLoads);
  const MotionTrack motion = smooth(game.tracks.front());
  result.smoothing = motion.report();
  result.low_sight_rate_Hz = low_sight_rate_Hz(game.report, *name);
  WheelLoads loads = loads_of(motion, robot, bin_s, observer);
  result.wheels = std::move(loads.wheels);
  result.clock_jumps = loads.jumps;
  result.unseen_s = loads.unseen_s;
  return result;
}

}  // namespace heatsoak::duty
