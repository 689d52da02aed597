#include "select/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "given_demand.h"
#include "motor/datasheet_network.h"
#include "select/load_simulation.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

class PaperTrace : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    motor_ = new motor::Motor(motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml"));
    duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
    shorten(duty, 40);
    const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
    trace_ = new Trace(simulate_load({.robot = robot, .motor = *motor_, .duty = duty, .every_s = 0.1}).trace);
  }
  static void TearDownTestSuite() {
    delete trace_;
    delete motor_;
  }
  static const Trace& trace() { return *trace_; }
  static const motor::Motor& motor() { return *motor_; }

 private:
  static inline const Trace* trace_ = nullptr;
  static inline const motor::Motor* motor_ = nullptr;
};

TEST_F(PaperTrace, what_is_booked_is_what_is_stored) {
  double into_motor_W = 0.0;
  double all_W = 0.0;
  for (const BookedHeat& each : trace().balance) {
    into_motor_W += each.node == "ambient" ? 0.0 : each.mean_W;
    all_W += std::abs(each.mean_W);
  }
  EXPECT_NEAR(into_motor_W, trace().stored_W, 1e-9 * all_W);
}

// Electrical energy = copper and drag heat + shaft work. Rows have 0.1 s, so only the change of the resistance within a row is neglected.
TEST_F(PaperTrace, power_into_the_terminals_is_heat_and_work) {
  double in_J = 0.0;
  double work_J = 0.0;
  double duration_s = 0.0;
  for (std::size_t i = 0; i + 1 < trace().rows.size(); ++i) {
    const TraceRow& row = trace().rows[i];
    const double step_s = trace().rows[i + 1].time_s - row.time_s;
    in_J += row.power_in_W * step_s;
    work_J += row.torque_Nm * row.speed_rad_per_s * step_s;
    duration_s += step_s;
  }
  double lost_W = 0.0;
  for (const BookedHeat& each : trace().balance) {
    lost_W += each.effect == "copper_loss" || each.effect == "no_load_loss" ? each.mean_W : 0.0;
  }
  EXPECT_NEAR(in_J / duration_s, lost_W + work_J / duration_s, 0.01 * lost_W);
}

// If the hot winding limits the current, the columns must contain the actual current.
TEST(TraceInVoltageLimit, columns_agree_with_the_account_and_with_the_driver) {
  const motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_30w_12v_200142.toml");
  duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  shorten(duty, 40);
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const Trace trace = simulate_load({.robot = robot, .motor = motor, .duty = duty, .every_s = 0.02}).trace;
  const motor::MotorValues& values = motor.nominal;
  double copper_J = 0.0;
  double most_V = 0.0;
  for (std::size_t i = 0; i + 1 < trace.rows.size(); ++i) {
    const TraceRow& row = trace.rows[i];
    const double resistance_ohm = values.terminal_resistance_ohm * (1.0 + values.temperature_coefficient_per_K * (row.winding_C - 25.0));
    copper_J += row.current_A * row.current_A * resistance_ohm * (trace.rows[i + 1].time_s - row.time_s);
    most_V = std::max(most_V, std::abs(row.motor_V + row.current_A * robot.drive.driver_resistance_ohm.value()));
  }
  const auto copper = std::ranges::find(trace.balance, "copper_loss", &BookedHeat::effect);
  ASSERT_NE(copper, trace.balance.end());
  EXPECT_NEAR(copper_J / trace.rows.back().time_s, copper->mean_W, 0.005 * copper->mean_W);
  EXPECT_NEAR(most_V, robot.available_V(), 1e-6);
}

TEST_F(PaperTrace, rows_are_no_further_apart_than_asked_and_reach_the_end) {
  for (std::size_t i = 1; i < trace().rows.size(); ++i) {
    EXPECT_GT(trace().rows[i].time_s, trace().rows[i - 1].time_s);
    EXPECT_LE(trace().rows[i].time_s, trace().rows[i - 1].time_s + 0.1 + 1e-9);
  }
  EXPECT_NEAR(trace().rows.back().time_s, 200.0, 1e-6);
  EXPECT_EQ(trace().rows.front().winding_C, 25.0);
}

TEST_F(PaperTrace, csv_has_a_row_for_each_and_a_header) {
  const std::string csv = to_csv(trace());
  EXPECT_EQ(csv.rfind("time_s,winding_C,stator_C,ambient_C,", 0), 0U);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), trace().rows.size() + 1);
}

}  // namespace
}  // namespace heatsoak::select
