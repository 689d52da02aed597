// The motors that the diagnosis is tested with.
#include <gtest/gtest.h>

#include "drive_rows.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

/// Checks the truth motor's integrator: steps four times as short change no sensor value noticeably, however light the parts.
TEST(TruthMotor, StepsAreShortEnoughForEveryMake) {
  Surprise quiet;
  quiet.flux_W = quiet.noise_K = quiet.step_K = quiet.outlier_probability = quiet.gap_probability = 0.0;
  const std::vector<RowInputs> rows = bench_rows(700, 5);
  for (const double share : {0.1, 0.37, 1.0, 1.25}) {
    MotorMake make;
    make.copper_capacity_J_per_K *= share;
    make.iron_capacity_J_per_K *= share;
    const TrueRun usual = run_motor(make, {}, quiet, rows, 0.0, 1, "usual");
    make.finer = 4;
    const TrueRun fine = run_motor(make, {}, quiet, rows, 0.0, 1, "fine");
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_NEAR(usual.winding_C[k], fine.winding_C[k], 1e-3) << share << " at " << k;
      EXPECT_NEAR(usual.stator_C[k], fine.stator_C[k], 1e-3) << share << " at " << k;
    }
  }
}

/// Energy balance: at standstill with constant current all copper loss leaves through the iron.
TEST(TruthMotor, LosesInTheEndWhatItTakesIn) {
  Surprise quiet;
  quiet.flux_W = quiet.noise_K = quiet.step_K = quiet.outlier_probability = quiet.gap_probability = 0.0;
  RowInputs held;
  held.current_A = 3.0;
  MotorMake make;
  make.copper_per_K = 0.0;
  const TrueRun run = run_motor(make, {}, quiet, std::vector<RowInputs>(7200, held), 0.0, 1, "held");
  const double heat_W = 9.0 * make.resistance_25C_ohm;
  // Iron parts are within 0.1 K of each other, so the sleeve matches the iron of the two-node formula within 1 %.
  EXPECT_NEAR(run.stator_C.back() - 25.0, heat_W * make.iron_to_air_K_per_W, 0.01 * heat_W * make.iron_to_air_K_per_W);
  EXPECT_NEAR(run.winding_C.back() - run.stator_C.back(), heat_W * make.copper_to_iron_K_per_W,
              0.02 * heat_W * make.copper_to_iron_K_per_W);
}

}  // namespace
}  // namespace heatsoak::attribution::truth
