// Tables of data sheet networks: the copper heat is linear in both temperatures, so the smallest table equals the exact answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "derate/barrier.h"
#include "derate/integer_form/quantised_table.h"
#include "guarded_motor.h"
#include "support/motors_of_database.h"

namespace heatsoak::derate {
namespace {

class ExactTable : public testing::TestWithParam<const char*> {};

// The third place of the winding's axis is 3 K above the limit, where no current is allowed any more.
TEST_P(ExactTable, DataSheetNeedsTheEndsOfItsAxesOnly) {
  const robot::Robot robot = shipped_robot(GetParam());
  const std::vector<std::string> ids = motors_of_database();
  ASSERT_GE(ids.size(), 31U);
  for (const std::string& id : ids) {
    const motor::Motor motor = shipped_motor(id);
    const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
    const Observer observer(network, motor.nominal, robot, 1.6);
    const BarrierRules rules = barrier_rules(motor, robot, {});
    const CurrentTable table = current_table(observer, rules);
    const double limit_C = rules.limits.winding_C;
    EXPECT_EQ(table.speed_rad_per_s.size(), 1U) << id;
    EXPECT_EQ(table.stator_C.size(), 2U) << id;
    EXPECT_EQ(table.winding_C, (std::vector{40.0, limit_C, limit_C + 3.0})) << id;
    EXPECT_LE(table.bound.shortfall_ratio, 1e-4) << id;
    Barrier barrier(observer, rules);
    const integer_form::QuantisedTable quantised(table);
    const heatsoak_integer_table integers = quantised.table();
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> uniform;
    double most_short = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double speed_rad_per_s = rules.most_speed_rad_per_s * uniform(engine);
      const double stator_C = static_cast<float>(std::lerp(40.0, limit_C, uniform(engine)));
      const double winding_C = static_cast<float>(std::lerp(40.0, limit_C, std::sqrt(uniform(engine))));
      const double exact_A = barrier.current_A(speed_rad_per_s, stator_C, winding_C);
      const double shown_A = static_cast<double>(
          table.allowed_A(static_cast<float>(speed_rad_per_s), static_cast<float>(stator_C), static_cast<float>(winding_C)));
      ASSERT_LE(shown_A, exact_A) << id << ": stator " << stator_C << ", winding " << winding_C;
      const int shown_mA =
          heatsoak_integer_allowed_mA(&integers, static_cast<int>(std::ceil(1e3 * speed_rad_per_s)),
                                      static_cast<int>(std::ceil(1e3 * stator_C)), static_cast<int>(std::ceil(1e3 * winding_C)));
      ASSERT_LE(1e-3 * shown_mA, exact_A) << id << ": stator " << stator_C << ", winding " << winding_C;
      if (exact_A >= table.straight_below_A) {
        most_short = std::max(most_short, 1.0 - shown_A / exact_A);
      }
    }
    EXPECT_LE(most_short, 1e-4) << id;
  }
}

INSTANTIATE_TEST_SUITE_P(robots, ExactTable, testing::Values("roboteam_twente_v2024", "tigers_v2020"),
                         [](const auto& instance) { return std::string(instance.param); });

// The division by the resistance must not give a colder winding more current.
TEST(ColdWinding, CountsAsTheFirstPlaceOfItsAxis) {
  const GuardedMotor guarded(ecx_32(), rules_for(ecx_32()), 1.6);
  const double first_A = guarded.table.allowed_A(0.0, 40.0, 40.0);
  for (const double winding_C : {-273.0, -200.0, 0.0, 39.9}) {
    EXPECT_EQ(guarded.table.allowed_A(0.0, 40.0, winding_C), first_A) << winding_C;
    EXPECT_EQ(guarded.table.allowed_A(0.0, 160.0, winding_C), guarded.table.allowed_A(0.0, 160.0, 40.0)) << winding_C;
  }
}

}  // namespace
}  // namespace heatsoak::derate
