// The integer header under attack: every motor of the database and motors with effects, hard use, and impossible readings. Overflow traps.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "derate/barrier.h"
#include "derate/integer_form/quantised_table.h"
#include "q15_header.h"
#include "support/motors_of_database.h"

namespace heatsoak::derate {
namespace {

constexpr const char* kTraps = "-O1 -fsanitize=undefined -fsanitize-undefined-trap-on-error";

/// Effects that the integer form can express, in motors of their own.
std::vector<std::string> integer_effects() {
  return {effect_table("radiation", estimated("emissive_area", "0.008 m2")),
          effect_table("ac_copper_loss", estimated("share", "0.35")) +
              effect_table("winding_through_flow", estimated("conductance", "0.06 W/K")),
          effect_table("pwm_ripple_loss", estimated("loss", "1.5 W") + estimated("stator_share", "0.6")),
          effect_table("third_node",
                       estimated("conductance", "0.3 W/K") + estimated("leak_ratio", "0.2") + estimated("heat_capacity", "60 J/K")),
          effect_table("load_friction", estimated("share", "0.05")) + effect_table("braking_heat", estimated("share", "0.3")),
          effect_table("driver_heat", estimated("loss", "1 W") + estimated("quadratic_share", "0.5")) +
              effect_table("connection_resistance", estimated("resistance", "0.02 ohm")),
          effect_table("armature_iron_loss", estimated("loss", "1.5 W")) +
              effect_table("air_gap_stirring", estimated("conductance", "0.08 W/K")),
          effect_table("remaining_loss", estimated("share", "0.5") + estimated("winding_share", "0.5")) +
              effect_table("windage", estimated("loss", "0.3 W")),
          hump("driver = \"speed\"\n" + estimated("first_knot", "0 rad/s") + estimated("last_knot", "600 rad/s"), 4.0)};
}

class Q15Attack : public Q15Header {
 protected:
  void attack(const Derating& derating, const std::string& what, long steps) {
    const StatedLimits stated(exported("c_header_q15", derating), derating.table);
    write_headers(derating);
    write("both.c", kBoth, derating);
    static_cast<void>(output_of(fmt::format("cc -std=c99 {} {} -o both both.c -lm", kWarnings, kTraps)));
    for (const char* const readings : {"", " extreme"}) {
      const Comparison found = comparison(output_of(fmt::format("./both {:.6g} {}{}", derating.table.straight_below_A, steps, readings)));
      EXPECT_LE(found.most_mA, 0.0) << what << readings;
      EXPECT_GE(found.coldest_mK, 0.0) << what << readings;
      if (*readings == '\0') {
        EXPECT_LE(found.hottest_mK, stated.excess_mK + 1.0) << what;
        EXPECT_LE(found.short_permille, stated.short_permille) << what;
      }
    }
  }
};

TEST_F(Q15Attack, AllowsNeverMoreThanSinglePrecisionInEveryMotorOfTheDatabase) {
  for (const std::string& id : motors_of_database()) {
    Derating derating = derating_of(shipped_motor(id));
    derating.motor_id = id;
    derating.uses.clear();  // those of another motor, whose lasting current may be too much for this one
    attack(derating, id, 20000);
  }
}

TEST_F(Q15Attack, AllowsNeverMoreThanSinglePrecisionWithEffects) {
  for (const std::string& lines : integer_effects()) {
    attack(derating_of(ecx_32_with(lines)), lines, 50000);
  }
}

// The table is lowered at its test points; these points lie elsewhere.
TEST_F(Q15Attack, TableWithEffectsIsNeverAboveTheNetworksAnswer) {
  for (const std::string& lines : integer_effects()) {
    const Derating derating = derating_of(ecx_32_with(lines));
    Barrier barrier(derating.observer, derating.rules);
    const integer_form::QuantisedTable quantised(derating.table);
    const heatsoak_integer_table integers = quantised.table();
    const double limit_C = derating.rules.limits.winding_C;
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 1000; ++i) {
      const double speed_rad_per_s = derating.rules.most_speed_rad_per_s * uniform(engine);
      const double stator_C = std::lerp(derating.rules.hottest_ambient_C, limit_C, uniform(engine));
      const double winding_C = std::lerp(derating.rules.hottest_ambient_C, limit_C, std::sqrt(uniform(engine)));
      const int shown_mA =
          heatsoak_integer_allowed_mA(&integers, static_cast<int>(std::ceil(1e3 * speed_rad_per_s)),
                                      static_cast<int>(std::ceil(1e3 * stator_C)), static_cast<int>(std::ceil(1e3 * winding_C)));
      EXPECT_LE(1e-3 * shown_mA, barrier.current_A(speed_rad_per_s, stator_C, winding_C))
          << lines << speed_rad_per_s << " rad/s, stator " << stator_C << ", winding " << winding_C;
    }
  }
}

}  // namespace
}  // namespace heatsoak::derate
