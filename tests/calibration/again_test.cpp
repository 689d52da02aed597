// A calibrated file is calibrated once more: what the first runs told is known, and no more than that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/diagnostic.h"
#include "identify/admission.h"
#include "motor/write_motor.h"
#include "study.h"

namespace heatsoak::study {
namespace {

class Again : public testing::Test {
 protected:
  /// Runs of 20 minutes of a motor that is a few percent off its sheet.
  std::vector<Recording> logs(int first) {
    LogMaking making;
    making.duration_s = 1200.0;
    std::vector<Recording> all;
    for (int run = first; run < first + 2; ++run) {
      all.push_back(read_log(write_log(generated_log(truth_, making, 11, static_cast<std::uint64_t>(run)),
                                       folder_.path() / ("run_" + std::to_string(run) + ".csv"))));
    }
    return all;
  }
  Motor rewritten(const Motor& motor, const Calibration& calibration) {
    const auto file = folder_.path() / "again.toml";
    std::ofstream(file) << to_toml(calibrated_motor(motor, calibration));
    return read_motor(file);
  }
  static double half_width(const Calibration& calibration, std::string_view name) {
    const auto found = std::ranges::find(calibration.figures, name, &CalibratedFigure::name);
    return 0.5 * std::log(found->high / found->low);
  }

  Folder folder_;
  Sheet sheet_{.truth = {}, .resistance_spread = ", tolerance = \"10 %\""};
  Motor motor_ = sheet_.motor(folder_);
  TwoNodeTruth truth_ = drawn_truth(sheet_, motor_, 3);
};

TEST_F(Again, CommonScaleIsNotLearnedByRepetition) {
  const Calibration first = calibrate(motor_, logs(0), {}, {});
  Motor motor = rewritten(motor_, first);
  const Calibration second = calibrate(motor, logs(2), {}, {});
  motor = rewritten(motor, second);
  const Calibration third = calibrate(motor, logs(4), {}, {});
  // No temperature tells the common scale of all heat.
  EXPECT_NEAR(half_width(second, "terminal_resistance"), half_width(first, "terminal_resistance"),
              0.1 * half_width(first, "terminal_resistance"));
  EXPECT_NEAR(half_width(third, "terminal_resistance"), half_width(first, "terminal_resistance"),
              0.1 * half_width(first, "terminal_resistance"));
  // Time constants are told, by three times the runs better.
  EXPECT_LT(half_width(third, "thermal_time_constant_winding"), 0.9 * half_width(first, "thermal_time_constant_winding"));
  EXPECT_GT(half_width(third, "thermal_time_constant_winding"), 0.4 * half_width(first, "thermal_time_constant_winding"));
  for (const CalibratedFigure& each : third.figures) {
    if (each.name == "thermal_time_constant_winding" || each.name == "thermal_time_constant_stator") {
      EXPECT_TRUE(each.is_identifiable) << each.name << ": known as well as before";
    }
  }
}

TEST_F(Again, RunsThatTheFileKnowsAreRefused) {
  const Calibration first = calibrate(motor_, logs(0), {}, {});
  const Motor motor = rewritten(motor_, first);
  try {
    refuse_runs_of_the_file(motor, logs(0), {});
    FAIL() << "was let pass";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    EXPECT_THAT(failure.what(), testing::HasSubstr("would count twice"));
  }
}

}  // namespace
}  // namespace heatsoak::study
