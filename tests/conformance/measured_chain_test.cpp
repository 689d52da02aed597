// From a log to a calibrated file, a diagnosed file and the verbs that read them, with measured power. The recording is not part of the
// repository; without it the test is skipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/measured_data.h"
#include "program_run.h"
#include "soak_example.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;

/// A motor of 52 kW with resistances of some mK/W. Half of its log determines neither the heat near the winding nor the heat factor.
TEST(MeasuredChain, EveryVerbReadsTheFilesOfAPowerBalance) {
  SKIP_WITHOUT_MEASURED_DATA("paderborn_pmsm");
  const TemporaryFolder folder;
  const fs::path reports = kSource / "reports/calibration";
  const std::string map = (reports / "paderborn_power_balance.map.toml").string();
  const std::string log = (*measured_data("paderborn_pmsm") / "profile24_2.5s.csv").string();
  const auto expect_success = [&](const std::vector<std::string>& words) {
    const ProgramRun done = run(words, in(folder));
    EXPECT_EQ(done.exit_code, 0) << words.front() << " " << done.err;
  };
  expect_success({"calibrate", "--motor", (reports / "lea_pmsm_52kw.toml").string(), "--map", map, log + "@0-50%", "--out", "fitted.toml"});
  expect_success(
      {"diagnose", "--model", "fitted.toml", "--map", map, "--train", log + "@0-50%", "--holdout", log + "@50-100%", "--out", "found"});
  for (const std::string& model : {std::string("fitted.toml"), std::string("found/fitted.toml")}) {
    expect_success({"predict", "--model", model, "--map", map, log});
    const ProgramRun evaluated = run(
        {"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--model", model, "--samples", "200"}, in(folder));
    EXPECT_LE(evaluated.exit_code, 1) << evaluated.err;
  }
}

}  // namespace
}  // namespace heatsoak
