// The fitted ramp, compared with a brute-force search, with the table, and under a load that uses all its current.
#include "derate/ramp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.h"
#include "exported_motor.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

/// Returns the table's lowest current, by a grid independent of the table's points.
double least_A(const Derating& derating, RampSignal signal, double signal_C) {
  double least = 1e9;
  for (int i = 0; i <= 60; ++i) {
    for (int k = 0; k <= 200; ++k) {
      const double speed_rad_per_s = derating.rules.most_speed_rad_per_s * i / 60.0;
      const double other_C = derating.rules.limits.winding_C * k / 200.0;
      least = std::min(least, signal == RampSignal::stator ? derating.table.allowed_A(speed_rad_per_s, signal_C, other_C)
                                                           : derating.table.allowed_A(speed_rad_per_s, other_C, signal_C));
    }
  }
  return least;
}

TEST(Ramp, AllowsNoMoreThanTheTableInAnyStateThatItCannotSee) {
  for (const RampSignal signal : {RampSignal::stator, RampSignal::winding}) {
    const CurrentRamp ramp = fit_ramp(ecx_derating(), signal);
    for (double signal_C = 0.0; signal_C < 170.0; signal_C += 0.7) {
      EXPECT_LE(ramp.current_A(signal_C), least_A(ecx_derating(), signal, signal_C) * (1.0 + 1e-9)) << signal_C;
    }
  }
}

TEST(Ramp, IsTheBestOfABruteForceSearch) {
  const CurrentRamp fitted = fit_ramp(ecx_derating(), RampSignal::stator);
  const auto mean_A = [](const CurrentRamp& ramp) {
    double sum_A = 0.0;
    for (int i = 0; i < 1150; ++i) {
      sum_A += ramp.current_A(40.0 + 0.1 * i + 0.05);
    }
    return sum_A / 1150.0;
  };
  std::vector<double> bound_A;
  for (int i = 0; i <= 230; ++i) {
    bound_A.push_back(ramp_bound_A(ecx_derating(), RampSignal::stator, 40.0 + 0.5 * i));
  }
  double best_A = 0.0;
  for (int start = 40; start < 155; start += 3) {
    for (int end = start + 1; end <= 155; end += 2) {
      for (double most_A = 0.0; most_A < 6.0; most_A += 0.02) {
        const CurrentRamp ramp{.start_C = 1.0 * start, .end_C = 1.0 * end, .most_current_A = most_A};
        bool is_safe = true;
        for (int i = 0; is_safe && i <= 230; ++i) {
          is_safe = ramp.current_A(40.0 + 0.5 * i) <= bound_A[static_cast<std::size_t>(i)];
        }
        best_A = is_safe ? std::max(best_A, mean_A(ramp)) : best_A;
      }
    }
  }
  EXPECT_GE(mean_A(fitted), best_A - 1e-9);
  EXPECT_LE(mean_A(fitted), best_A * 1.03);
  EXPECT_NEAR(ramp_loss(ecx_derating(), RampSignal::stator, fitted).ramp_mean_A, mean_A(fitted), 0.01);
}

TEST(Ramp, StartsLaterWhereTheControllerDoes) {
  const CurrentRamp ramp = fit_ramp(ecx_derating(), RampSignal::winding, 0.1);
  EXPECT_EQ(ramp.current_A(ramp.start_C + 0.1), ramp.most_current_A);
  EXPECT_LE(ramp.most_current_A, ramp_bound_A(ecx_derating(), RampSignal::winding, ramp.start_C + 0.1));
  EXPECT_EQ(ramp.current_A(ramp.end_C), 0.0);
}

TEST(Ramp, RefusesByName) {
  const auto message = [](const Derating& derating, RampSignal signal) -> std::string {
    try {
      static_cast<void>(ramp_for("moteus", derating, signal));
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      return failure.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(ecx_derating(), RampSignal::stator), "accepted");
  Derating fast = ecx_derating();
  fast.reachable_speed_rad_per_s = 2.0 * fast.rules.most_speed_rad_per_s;
  EXPECT_THAT(message(fast, RampSignal::stator), HasSubstr("moteus cannot express that above"));
  Derating limited = ecx_derating();
  limited.rules.limits.stator_C = 100.0;
  EXPECT_THAT(message(limited, RampSignal::winding), HasSubstr("moteus cannot express the stator limit of 100 °C"));
  Derating broken = ecx_derating();
  broken.table.heat_per_ohm_A2[3] = std::nan("");
  EXPECT_THAT(message(broken, RampSignal::stator), HasSubstr("is not a number"));
  Derating none = ecx_derating();
  std::ranges::fill(none.table.heat_per_ohm_A2, 0.0);
  EXPECT_THAT(message(none, RampSignal::stator), HasSubstr("allows no current"));
}

}  // namespace
}  // namespace heatsoak::derate
