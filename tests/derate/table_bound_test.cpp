// Table compared with the exact solution: never above it, not far below, continuous, no steeper than stated, and small.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "derate/barrier.h"
#include "guarded_motor.h"

namespace heatsoak::derate {
namespace {

constexpr const char* kLossy = R"([effects.eddy]
type = "ac_copper_loss"
share = { value = "0.2", origin = "estimated", derivation = "a test" }

[effects.flow]
type = "winding_through_flow"
conductance = { value = "0.1 W/K", origin = "estimated", derivation = "a test" }
)";

/// Motors of the database: one has losses that depend on the speed, another has a stator limit.
struct Case {
  std::string name;
  motor::Motor motor;
  BarrierRules rules;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* const id : {"maxon_ecx_flat_32l_48v", "maxon_ecx_flat_42m_24v", "maxon_ec45_flat_70w_24v", "maxon_dcx19s_24v"}) {
    all.push_back({id, shipped_motor(id), rules_for(shipped_motor(id))});
  }
  all.push_back({"lossy", ecx_32_with(kLossy), rules_for(ecx_32())});
  all.push_back({"stator limit", ecx_32(), rules_for(ecx_32())});
  all.back().rules.limits.stator_C = 73.0;
  return all;
}

struct Place {
  double speed_rad_per_s;
  double stator_C;
  double winding_C;
};

/// Random states up to the limits, half of them near these.
class Places {
 public:
  explicit Places(const BarrierRules& rules) : rules_(rules) {}
  Place next() {
    const double limit_C = rules_.limits.winding_C;
    const double stator_limit_C = rules_.limits.stator_C.value_or(limit_C);
    const bool is_near = uniform() < 0.5;
    const auto up_to = [&](double end_C) { return is_near ? end_C - 12.0 * uniform() : std::lerp(25.0, end_C, uniform()); };
    return {rules_.most_speed_rad_per_s * uniform(), up_to(stator_limit_C), up_to(limit_C)};
  }
  double uniform() { return std::uniform_real_distribution<double>()(engine_); }

 private:
  const BarrierRules& rules_;
  std::mt19937_64 engine_{41};
};

TEST(TableBound, HoldsOnPointsThatTheTableHasNotSeen) {
  for (const Case& each : cases()) {
    for (const double goal : {0.01, 0.05}) {
      const thermal::Network network = motor::datasheet_network(each.motor, motor::nominal_sample(each.motor));
      const Observer observer(network, each.motor.nominal, twente(), 1.6);
      const CurrentTable table = current_table(observer, each.rules, {.shortfall_ratio = goal});
      Barrier barrier(observer, each.rules);
      Places places(each.rules);
      double most_short = 0.0;
      for (int i = 0; i < 6000; ++i) {
        const Place at = places.next();
        const double exact_A = barrier.current_A(at.speed_rad_per_s, std::max(40.0, at.stator_C), std::max(40.0, at.winding_C));
        const double shown_A = table.allowed_A(at.speed_rad_per_s, at.stator_C, at.winding_C);
        ASSERT_LE(shown_A, exact_A * (1.0 + 1e-6))
            << each.name << ": " << at.speed_rad_per_s << " rad/s, stator " << at.stator_C << ", winding " << at.winding_C;
        if (exact_A >= table.straight_below_A) {
          most_short = std::max(most_short, 1.0 - shown_A / exact_A);
        }
      }
      EXPECT_LE(most_short, table.bound.shortfall_ratio + 0.002) << each.name;
      if (!each.rules.limits.stator_C) {
        EXPECT_GT(most_short, 0.2 * table.bound.shortfall_ratio) << each.name << ": the bound says nothing";
        EXPECT_LE(table.bound.shortfall_ratio, goal) << each.name;
      }
    }
  }
}

// Only a measured stator or a restart can give a stator above its axis.
TEST(TableBound, HoldsForAStatorAboveItsAxis) {
  for (const Case& each : cases()) {
    const GuardedMotor guarded(each.motor, each.rules, 1.6);
    Barrier barrier(guarded.observer, guarded.rules);
    Places places(each.rules);
    for (int i = 0; i < 2000; ++i) {
      Place at = places.next();
      at.stator_C = guarded.table.stator_C.back() + 8.0 * places.uniform();
      EXPECT_LE(guarded.table.allowed_A(at.speed_rad_per_s, at.stator_C, at.winding_C),
                barrier.current_A(at.speed_rad_per_s, at.stator_C, std::max(40.0, at.winding_C)) * (1.0 + 1e-6) + 1e-9)
          << each.name << ": stator " << at.stator_C << ", winding " << at.winding_C;
    }
  }
}

// Lines through the table with 20 steps per kelvin. A discontinuity would appear as a slope far above the stated one.
TEST(TableBound, CurrentIsContinuousAndNoSteeperThanStated) {
  for (const Case& each : cases()) {
    const GuardedMotor guarded(each.motor, each.rules, 1.6);
    const CurrentTable& table = guarded.table;
    constexpr double kStep = 0.05;
    Places places(each.rules);
    double winding_slope = 0.0;
    double stator_slope = 0.0;
    double speed_slope = 0.0;
    for (int line = 0; line < 60; ++line) {
      const Place at = places.next();
      for (double x_C = 20.0; x_C < 200.0; x_C += kStep) {
        const auto slope = [&](double low_A, double high_A) { return std::abs(high_A - low_A) / kStep; };
        winding_slope = std::max(winding_slope, slope(table.allowed_A(at.speed_rad_per_s, at.stator_C, x_C),
                                                      table.allowed_A(at.speed_rad_per_s, at.stator_C, x_C + kStep)));
        stator_slope = std::max(stator_slope, slope(table.allowed_A(at.speed_rad_per_s, x_C, at.winding_C),
                                                    table.allowed_A(at.speed_rad_per_s, x_C + kStep, at.winding_C)));
      }
      for (double x = 0.0; x < 1.1 * table.no_current_speed_rad_per_s; x += kStep) {
        speed_slope = std::max(
            speed_slope,
            std::abs(table.allowed_A(x + kStep, at.stator_C, at.winding_C) - table.allowed_A(x, at.stator_C, at.winding_C)) / kStep);
      }
    }
    constexpr double kRounding = 1.001;
    EXPECT_LE(winding_slope, kRounding * table.bound.winding_slope_A_per_K) << each.name;
    EXPECT_LE(stator_slope, kRounding * table.bound.stator_slope_A_per_K) << each.name;
    EXPECT_LE(speed_slope, kRounding * table.bound.speed_slope_A_s_per_rad) << each.name;
    EXPECT_GT(winding_slope, 0.5 * table.bound.winding_slope_A_per_K) << each.name << ": the stated slope says nothing";
  }
}

TEST(TableBound, AxisThatDoesNotMatterHasOnePlace) {
  const GuardedMotor plain(ecx_32(), rules_for(ecx_32()), 1.6);
  EXPECT_EQ(plain.table.speed_rad_per_s.size(), 1U);
  const GuardedMotor lossy(ecx_32_with(kLossy), rules_for(ecx_32()), 1.6);
  EXPECT_GT(lossy.table.speed_rad_per_s.size(), 1U);
}

TEST(TableBound, SizeAndErrorAreTradedAsAsked) {
  const motor::Motor motor = ecx_32_with(kLossy);
  const BarrierRules rules = rules_for(ecx_32());
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const Observer observer(network, motor.nominal, twente(), 1.6);
  const CurrentTable fine = current_table(observer, rules, {.shortfall_ratio = 0.001});
  const CurrentTable coarse = current_table(observer, rules, {.shortfall_ratio = 0.1});
  EXPECT_LT(2 * coarse.size_bytes(), fine.size_bytes());
  const CurrentTable small = current_table(observer, rules, {.shortfall_ratio = 0.002, .most_bytes = 150});
  EXPECT_LE(small.size_bytes(), 150U);
  EXPECT_GT(small.bound.shortfall_ratio, 0.002);
}

// With an old or a fresh contact, whichever is hotter, the exact current has an edge, which no grid of breakpoints follows.
TEST(TableBound, NoNumberIsStoredThatDoesNotLowerTheShortfall) {
  const motor::Motor motor = ecx_32_with(effect_table(
      "contact_ageing", estimated("conductance", "0.06 W/K") + estimated("time_constant", "10 h") + estimated("fresh_share", "1")));
  const BarrierRules rules = rules_for(motor, approach_s(motor, DerateOptions()));
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const Observer observer(network, motor.nominal, twente(), 1.6);
  const CurrentTable fine = current_table(observer, rules, {.shortfall_ratio = 0.002});
  ASSERT_GT(fine.bound.shortfall_ratio, 0.002) << "the example reaches the goal";
  EXPECT_FALSE(fine.bound.is_limited_by_size);
  const CurrentTable asked = current_table(observer, rules, {.shortfall_ratio = fine.bound.shortfall_ratio});
  EXPECT_LE(fine.size_bytes(), asked.size_bytes());
  EXPECT_LT(fine.size_bytes(), 200U);
}

/// Returns the smallest number of points for linear interpolation of the current, from 40 °C to the temperature with current `least_A`.
/// Each line is as long as the goal allows. The current is concave there, so the lines stay below it.
int places_of_straight_currents(Barrier& barrier, double stator_C, double least_A, double goal) {
  const auto current_A = [&](double winding_C) { return barrier.current_A(0.0, stator_C, winding_C); };
  constexpr double kStep_K = 0.25;
  double end_C = 40.0;
  while (current_A(end_C + kStep_K) >= least_A) {
    end_C += kStep_K;
  }
  const auto is_good = [&](double from_C, double to_C) {
    for (double at_C = from_C; at_C < to_C; at_C += kStep_K) {
      const double line_A = std::lerp(current_A(from_C), current_A(to_C), (at_C - from_C) / (to_C - from_C));
      if (line_A < (1.0 - goal) * current_A(at_C)) {
        return false;
      }
    }
    return true;
  };
  int places = 1;
  for (double from_C = 40.0; from_C < end_C; ++places) {
    double to_C = from_C + kStep_K;
    while (to_C < end_C && is_good(from_C, to_C + kStep_K)) {
      to_C += kStep_K;
    }
    from_C = to_C;
  }
  return places;
}

// Alternative method: linear interpolation of the current between optimal points.
TEST(TableBound, HeatsNeedFewerPlacesThanCurrents) {
  constexpr double kGoal = 0.01;
  for (const char* const id : {"maxon_ecx_flat_32l_48v", "maxon_ecx_flat_42m_24v", "maxon_ec45_flat_70w_24v"}) {
    const motor::Motor motor = shipped_motor(id);
    const BarrierRules rules = rules_for(motor);
    const GuardedMotor guarded(motor, rules, 1.6);
    Barrier barrier(guarded.observer, rules);
    const int rival = places_of_straight_currents(barrier, 155.0, guarded.table.straight_below_A, kGoal);
    EXPECT_LT(static_cast<int>(guarded.table.winding_C.size()), rival) << id;
  }
}

}  // namespace
}  // namespace heatsoak::derate
