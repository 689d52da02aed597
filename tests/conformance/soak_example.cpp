#include "soak_example.h"

#include <gtest/gtest.h>

namespace heatsoak {

Calibrated::Calibrated(const std::string& threads) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"calibrate", "--motor", kMotor, log("bench.csv"), log("match_1.csv"), log("match_2.csv"), "--holdout",
                               log("match_3.csv"), "--out", "measured_motor.toml", "--json", "-", "--seed", "5", "--threads", threads},
                              in(folder));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  if (done.exit_code == 0) {
    motor_file = content_of(folder.path() / "measured_motor.toml");
    answer = done.json();
  }
}

const Calibrated& example_calibration() {
  static const Calibrated kOnce("1");
  return kOnce;
}

}  // namespace heatsoak
