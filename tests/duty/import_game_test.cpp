// Imports a complete recording of a tournament game, compressed and truncated at the end. It has overlapping cameras that disagree, a
// tracker, a referee and a robot that is lost twice. The motion is defined by formulas, so the wheel loads are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "duty/game_to_demand.h"
#include "robot/inverse_dynamics.h"
#include "ssl_log_writer.h"
#include "support/source_folder.h"

namespace heatsoak::duty {
namespace {

using namespace testing_logs;

constexpr double kLength_s = 60.0;
/// Times without sight of the robot: two seconds split the track, a short gap is bridged.
bool is_lost(double time_s) { return (time_s > 30.0 && time_s < 32.0) || (time_s > 45.0 && time_s < 45.2); }

/// Sum of sines with exact velocity and acceleration.
struct Sine {
  double amplitude = 0.0;
  double rate_rad_per_s = 0.0;
  [[nodiscard]] double at(double time_s, int derivative) const {
    return amplitude * std::pow(rate_rad_per_s, derivative) * std::sin(rate_rad_per_s * time_s + 0.5 * std::numbers::pi * derivative);
  }
};
constexpr Sine kX{1.2, 1.0};
constexpr Sine kY{0.8, 1.4};
constexpr Sine kYaw{0.5, 0.8};

/// Two cameras over the halves of the field overlap in the middle and differ by 8 mm; noise of 1 mm.
std::string recording() {
  LogWriter log;
  base::Random random(11, 0);
  const auto noise_m = [&] { return 1e-3 * 3.46 * (random.uniform() - 0.5); };
  const Message geometry = Message().message(2, camera_at(0, -1.5, 0.0)).message(2, camera_at(1, 1.5, 0.0));
  log.add(0.0, 3, referee(0.0, 1, 2));
  for (int i = 0; i * kFrame_s < kLength_s; ++i) {
    const double time_s = i * kFrame_s;
    const SeenRobot truth{true, 3, kX.at(time_s, 0), kY.at(time_s, 0), kYaw.at(time_s, 0)};
    const SeenRobot other{false, 3, 2.0, -1.0, 0.3};
    for (int camera = 0; camera < 2; ++camera) {
      const bool sees = camera == 0 ? truth.x_m < 0.4 : truth.x_m > -0.4;
      SeenRobot seen = truth;
      seen.x_m += noise_m() + (camera == 0 ? -0.004 : 0.004);
      seen.y_m += noise_m();
      seen.yaw_rad += 2.0 * noise_m();
      std::vector<SeenRobot> robots{other};
      if (sees && !is_lost(time_s)) {
        robots.push_back(seen);
      }
      log.add(time_s, 4, vision(time_s + 0.003 * camera, camera, robots, i % 300 == 0 ? &geometry : nullptr));
    }
    log.add(time_s, 5, tracked(time_s, "abc", "a tracker", {truth}));
  }
  const std::string packed = gzip(log.bytes());
  return packed.substr(0, packed.size() * 98 / 100);
}

// ∫M²dt of every wheel determines the heat of its motor.
TEST(ImportGame, a_damaged_recording_gives_the_wheels_work) {
  const TemporaryFile file("game.log.gz", recording());
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/tigers_v2020.toml");
  const GameDemand game = demand_of_game(file.path(), "yellow 3", robot, 0.05);
  ASSERT_EQ(game.wheels.size(), 4U);
  const double seen_until_s = game.wheels[0].duration_s();
  EXPECT_GT(seen_until_s, 0.9 * kLength_s);
  EXPECT_LT(seen_until_s, kLength_s);
  motor::MotorValues no_rotor;
  no_rotor.rotor_inertia_kg_m2 = 0.0;
  const robot::BodyConfig body = robot::make_body(robot, no_rotor);
  robot::PerWheel expected_Nm2_s{};
  for (double time_s = 0.0; time_s < seen_until_s; time_s += 1e-3) {
    if (time_s > 30.0 && time_s < 32.0) {
      continue;
    }
    const robot::WheelDemands wheels =
        robot::inverse_dynamics(body, robot::local_motion(body, {kX.at(time_s, 0), kY.at(time_s, 0), kYaw.at(time_s, 0)},
                                                          {kX.at(time_s, 1), kY.at(time_s, 1), kYaw.at(time_s, 1)},
                                                          {kX.at(time_s, 2), kY.at(time_s, 2), kYaw.at(time_s, 2)}));
    for (std::size_t i = 0; i < 4; ++i) {
      expected_Nm2_s[i] += 1e-3 * wheels.torque_Nm[i] * wheels.torque_Nm[i];
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    double found_Nm2_s = 0.0;
    for (const LoadBin& bin : game.wheels[i].bins) {
      found_Nm2_s += bin.torque_rms_Nm * bin.torque_rms_Nm * bin.duration_s;
    }
    EXPECT_NEAR(found_Nm2_s / expected_Nm2_s[i], 1.0, 0.05) << i;
  }
  // The findings must include the gap, the end of the file, and the source that was used.
  EXPECT_EQ(game.log.source.kind, PositionSource::Kind::vision);
  EXPECT_EQ(game.log.source.cameras, 2U);
  EXPECT_NEAR(game.unseen_s, 2.0, 0.1);
  EXPECT_THAT(game.log.notes, testing::ElementsAre(testing::VariantWith<BytesEndEarly>(testing::_)));
}

}  // namespace
}  // namespace heatsoak::duty
