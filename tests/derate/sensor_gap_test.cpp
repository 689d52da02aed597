// Gaps in the readings of a temperature sensor: the allowed current moves, it does not jump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sensed_motor.h"

namespace heatsoak::derate {
namespace {

const CompiledGuard& gap_guard() {
  static const CompiledGuard made(thermistor_derating(), "gaps");
  return made;
}

constexpr double kStep_s = 0.01;
constexpr double kRoom_C = 39.5;
constexpr int kWarm = 60'000;  ///< periods until the motor is hot

/// Returns the current that was allowed in each period after the warm-up, always fully used at standstill. `reading(time_s, true_C)` gets
/// the time since the warm-up, and NaN in place of the reading means none.
template <class Reading>
std::vector<double> currents_A(int periods, const Reading& reading, double speed_rad_per_s = 0.0) {
  SensedGuard sensed(gap_guard());
  Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), kRoom_C);
  sensed.start(static_cast<float>(kRoom_C));
  std::vector<double> all_A;
  double now_A = 0.0;
  for (int i = 0; i < kWarm + periods; ++i) {
    plant.step(now_A, speed_rad_per_s, kRoom_C, kStep_s);
    const double true_C = plant.true_C(motor::states::stator);
    const double shown_C = i < kWarm ? true_C : reading(kStep_s * (i - kWarm), true_C);
    now_A = sensed
                .step({static_cast<float>(now_A), static_cast<float>(speed_rad_per_s), static_cast<float>(kRoom_C)},
                      static_cast<float>(shown_C))
                .allowed_A;
    if (i >= kWarm) {
      all_A.push_back(now_A);
    }
  }
  return all_A;
}

double largest_step_A(const std::vector<double>& all_A) {
  double most_A = 0.0;
  for (std::size_t i = 1; i < all_A.size(); ++i) {
    most_A = std::max(most_A, std::abs(all_A[i] - all_A[i - 1]));
  }
  return most_A;
}

constexpr double kNone_C = std::numeric_limits<double>::quiet_NaN();

TEST(SensedCurrent, MovesSmoothlyThroughGapsInTheReadings) {
  const auto all_A = currents_A(3000, [](double time_s, double true_C) { return std::fmod(time_s, 5.0) < 3.8 ? true_C : kNone_C; });
  const auto [least, most] = std::ranges::minmax(all_A);
  RecordProperty("difference_A", std::to_string(most - least));
  RecordProperty("step_A", std::to_string(largest_step_A(all_A)));
  EXPECT_GT(most - least, 0.1) << "the gaps are long enough to change the current";
  EXPECT_LT(largest_step_A(all_A), 0.005);
}

// Never above the current that holds at the time: without readings it ends at the current without a sensor.
TEST(SensedCurrent, IsNeverAboveThatOfAnUninterruptedSensor) {
  const auto whole_A = currents_A(700, [](double, double true_C) { return true_C; });
  const auto gap_A = currents_A(700, [](double time_s, double true_C) { return time_s < 1.0 ? true_C : kNone_C; });
  for (std::size_t i = 0; i < 200; ++i) {
    ASSERT_LE(gap_A[i], whole_A[i] + 0.01) << i;
  }
  EXPECT_NEAR(gap_A[145], whole_A[145], 0.02) << "a gap of less than half a second costs nothing";
  EXPECT_LT(gap_A[200], whole_A[200] - 0.1);
}

// With a cold winding the sensor's table allows less than that without a sensor: it holds whenever there are readings.
TEST(SensedCurrent, OfAColdMotorIsNeverAboveThatOfItsReadings) {
  SensedGuard gaps(gap_guard());
  SensedGuard whole(gap_guard());
  SensedGuard never(gap_guard());
  for (SensedGuard* const each : {&gaps, &whole, &never}) {
    each->start(20.0F);
  }
  const CompiledGuard::Input in{0.0F, 0.0F, 20.0F};
  float last_A = 0.0F;
  for (int i = 0; i < 2000; ++i) {
    const bool is_gap = i % 500 >= 250;
    const float gaps_A = gaps.step(in, is_gap ? std::nanf("") : 20.0F).allowed_A;
    const float whole_A = whole.step(in, 20.0F).allowed_A;
    const float never_A = never.step(in, std::nanf("")).allowed_A;
    ASSERT_LT(whole_A, never_A - 0.1F) << i;
    ASSERT_LE(gaps_A, (is_gap ? never_A : whole_A) + 1e-3F) << i;
    if (i > 0) {
      ASSERT_LT(gaps_A - last_A, 0.01F) << i;
      ASSERT_LT(last_A - gaps_A, 0.3F) << i;
    }
    if (i % 500 == 499) {
      ASSERT_NEAR(gaps_A, never_A, 0.01F) << i;
    }
    last_A = gaps_A;
  }
}

// The header states this bound, docs/sensors.md the step.
TEST(SensedCurrent, FallsAtOnceWhenTheSensorIsDropped) {
  double stated_A = 0.0;
  for (const LastingCurrent& each : thermistor_derating().sensor->lasting) {
    stated_A = std::max(stated_A, each.with_A - each.without_A);
  }
  double most_A = 0.0;
  for (const double speed_rad_per_s : {0.0, 400.0}) {
    for (const double shown_C : {50.0, 10.0, 200.0}) {
      const auto all_A = currents_A(
          3000, [&](double, double) { return shown_C; }, speed_rad_per_s);
      most_A = std::max(most_A, largest_step_A(all_A));
      for (std::size_t i = 1; i < all_A.size(); ++i) {
        ASSERT_LE(all_A[i] - all_A[i - 1], 0.01) << shown_C << " degC, " << i;
      }
    }
  }
  RecordProperty("step_A", std::to_string(most_A));
  EXPECT_LE(most_A, stated_A);
  EXPECT_NEAR(most_A, 0.30, 0.1);
}

}  // namespace
}  // namespace heatsoak::derate
