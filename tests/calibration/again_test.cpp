// Repeated calibration of a calibrated file: the knowledge from the first runs is kept and not counted twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/diagnostic.h"
#include "calibration/admission.h"
#include "motor/write_motor.h"
#include "study.h"

namespace heatsoak::calibration::study {
namespace {

class Again : public testing::Test {
 protected:
  /// Returns logs of 20 minutes for a motor that is a few per cent off its data sheet.
  std::vector<recording::Recording> logs(int first) {
    estimation::LogMaking making;
    making.duration_s = 1200.0;
    std::vector<recording::Recording> all;
    for (int run = first; run < first + 2; ++run) {
      all.push_back(read_log(write_log(estimation::generated_log(truth_, making, 11, static_cast<std::uint64_t>(run)),
                                       folder_.path() / ("run_" + std::to_string(run) + ".csv"))));
    }
    return all;
  }
  motor::Motor rewritten(const motor::Motor& motor, const Calibration& calibration) {
    const auto file = folder_.path() / "again.toml";
    std::ofstream(file) << motor::to_toml(calibrated_motor(motor, calibration));
    return motor::read_motor(file);
  }
  static double half_width(const Calibration& calibration, std::string_view name) {
    const auto found = std::ranges::find(calibration.parameters, name, &CalibratedParameter::name);
    return 0.5 * std::log(found->high / found->low);
  }

  Folder folder_;
  Sheet sheet_{.truth = {}, .resistance_spread = ", tolerance = \"10 %\""};
  motor::Motor motor_ = sheet_.motor(folder_);
  estimation::TwoNodeTruth truth_ = drawn_truth(sheet_, motor_, 3);
};

TEST_F(Again, CommonScaleIsNotLearnedByRepetition) {
  const Calibration first = calibrate(motor_, logs(0), {}, {});
  motor::Motor motor = rewritten(motor_, first);
  const Calibration second = calibrate(motor, logs(2), {}, {});
  motor = rewritten(motor, second);
  const Calibration third = calibrate(motor, logs(4), {}, {});
  // Temperatures alone do not determine the common scale of all heat.
  EXPECT_NEAR(half_width(second, "terminal_resistance"), half_width(first, "terminal_resistance"),
              0.1 * half_width(first, "terminal_resistance"));
  EXPECT_NEAR(half_width(third, "terminal_resistance"), half_width(first, "terminal_resistance"),
              0.1 * half_width(first, "terminal_resistance"));
  // Time constants are identifiable, and three times the runs narrow their intervals.
  EXPECT_LT(half_width(third, "thermal_time_constant_winding"), 0.9 * half_width(first, "thermal_time_constant_winding"));
  EXPECT_GT(half_width(third, "thermal_time_constant_winding"), 0.4 * half_width(first, "thermal_time_constant_winding"));
  for (const CalibratedParameter& each : third.parameters) {
    if (each.name == "thermal_time_constant_winding" || each.name == "thermal_time_constant_stator") {
      EXPECT_TRUE(each.is_identifiable) << each.name << ": known as well as before";
    }
  }
}

/// Runs are compared by content, because a run may have another name or clock, and names may repeat.
TEST_F(Again, RunsThatTheFileKnowsAreRefused) {
  const std::vector<recording::Recording> known = logs(0);
  motor::Motor motor = rewritten(motor_, calibrate(motor_, known, {}, {}));
  const auto is_refused = [&motor](const recording::Recording& recording) {
    try {
      refuse_runs_of_the_file(motor, {&recording, 1}, {});
      return false;
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      EXPECT_THAT(failure.what(), testing::HasSubstr("would count twice"));
      return true;
    }
  };
  const auto file = [this](const char* name) { return folder_.path() / name; };
  EXPECT_TRUE(is_refused(known[0]));
  EXPECT_TRUE(is_refused(recording::part_of(known[0], 0.4, 0.6)));
  EXPECT_TRUE(is_refused(read_log(write_log(known[0], file("copy.csv")))));
  recording::Recording later = known[0];
  std::ranges::for_each(later.time_s, [](double& time_s) { time_s += 3600.0; });
  EXPECT_TRUE(is_refused(read_log(write_log(later, file("later.csv")))));
  const std::vector<recording::Recording> others = logs(2);
  EXPECT_FALSE(is_refused(read_log(write_log(others[0], file("run_0.csv")))));
  // Runs of earlier fits are still known after another fit. Files that list only names are compared by name.
  motor = rewritten(motor, calibrate(motor, others, {}, {}));
  EXPECT_TRUE(is_refused(known[1]));
  motor.fit->runs = {"run_1"};
  EXPECT_TRUE(is_refused(known[1]));
  EXPECT_FALSE(is_refused(known[0]));
}

TEST_F(Again, PartsOfALogThatDoNotOverlapAreTwoRuns) {
  const recording::Recording log = logs(0).front();
  const motor::Motor motor = rewritten(motor_, calibrate(motor_, std::vector{recording::part_of(log, 0.0, 0.5)}, {}, {}));
  EXPECT_TRUE(was_fitted_to(*motor.fit, recording::part_of(log, 0.4, 0.6)));
  EXPECT_FALSE(was_fitted_to(*motor.fit, recording::part_of(log, 0.5, 1.0)));
}

}  // namespace
}  // namespace heatsoak::calibration::study
