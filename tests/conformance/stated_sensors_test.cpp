// Sensor errors and curves in a motor file: the output of `describe` can be pasted into the file, and every verb accepts it.
#include <gtest/gtest.h>

#include "program_run.h"
#include "soak_example.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;

class SensorLines : public testing::TestWithParam<std::string> {
 protected:
  SensorLines() {
    const std::string text = run({"describe", GetParam()}).out;
    const std::size_t mark = text.find("\nat the end of a motor file");
    EXPECT_NE(mark, std::string::npos) << text;
    write(motor_, content_of(kSource / "motor_db" / (std::string(kMotor) + ".toml")) + "\n" + text.substr(text.find('\n', mark + 1) + 1));
  }
  const TemporaryFolder folder_;
  const fs::path motor_ = folder_.path() / "motor.toml";
};

TEST_P(SensorLines, make_a_motor_file_that_says_the_same_of_the_motor) {
  const ProgramRun lint = run({"lint", motor_.string()});
  EXPECT_EQ(lint.exit_code, 0) << lint.out << lint.err;
  const auto evaluated = [](const std::string& motor) {
    return run({"evaluate", "--motors", motor, "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "8",
                "--json", "-"})
        .json()
        .at("motors")
        .at(0);
  };
  for (const char* key : {"winding_peak_C", "stator_peak_C", "verdict", "data_quality"}) {
    EXPECT_EQ(evaluated(motor_.string()).at(key), evaluated(kMotor).at(key)) << key;
  }
}

TEST_P(SensorLines, add_what_is_shown_to_a_simulation) {
  RunOptions here;
  here.folder = folder_.path();
  const ProgramRun done =
      run({"simulate", "--motor", "motor.toml", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--out", "trace.csv"},
          here);
  EXPECT_LE(done.exit_code, 1) << done.err;
  const bool is_winding = GetParam().ends_with("winding");
  const std::string trace = content_of(folder_.path() / "trace.csv");
  const std::string header = trace.substr(0, trace.find('\n'));
  EXPECT_EQ(header.find(",winding_shown_C,") != std::string::npos, is_winding) << header;
  EXPECT_EQ(header.find(",stator_shown_C,") != std::string::npos, !is_winding) << header;
}

TEST_P(SensorLines, are_reported_with_their_size) {
  const ProgramRun told = run({"describe", motor_.string(), "--json", "-"});
  ASSERT_EQ(told.json().at("sensors").size(), 1U) << told.out;
  EXPECT_EQ(told.json().at("sensors").at(0).at("type"), GetParam());
  EXPECT_NE(told.err.find(GetParam()), std::string::npos) << told.err;
}

TEST_P(SensorLines, are_held_in_a_calibration) {
  RunOptions here;
  here.folder = folder_.path();
  const ProgramRun done =
      run({"calibrate", "--motor", "motor.toml", (kSoak / "bench.csv").string() + "@0-20%", "--out", "fitted.toml", "--explain"}, here);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE((done.out + done.err).find("effects.my_" + GetParam()), std::string::npos) << done.out << done.err;
  EXPECT_NE(content_of(folder_.path() / "fitted.toml").find("[effects.my_" + GetParam() + "]"), std::string::npos);
}

/// A curve over the speed needs no other effect. It applies wherever a prediction has a speed.
TEST(CurveLines, act_in_an_evaluation_and_it_says_nothing_else) {
  const std::string text = run({"describe", "tabulated"}).out;
  const std::size_t mark = text.find("\nat the end of a motor file");
  ASSERT_NE(mark, std::string::npos) << text;
  const TemporaryFolder folder;
  const fs::path motor = folder.path() / "motor.toml";
  write(motor, content_of(kSource / "motor_db" / (std::string(kMotor) + ".toml")) + "\n" + text.substr(text.find('\n', mark + 1) + 1));
  const auto evaluated = [](const std::string& name) {
    return run({"evaluate", "--motors", name, "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "0",
                "--json", "-"});
  };
  const ProgramRun with = evaluated(motor.string());
  EXPECT_EQ((with.out + with.err).find("left out, because"), std::string::npos) << with.err;
  const auto peak_C = [](const ProgramRun& run) { return run.json().at("motors").at(0).at("stator_peak_C").at("nominal").get<double>(); };
  EXPECT_GT(peak_C(with), peak_C(evaluated(kMotor)) + 0.1) << "its heat is there";
}

INSTANTIATE_TEST_SUITE_P(catalogue, SensorLines, testing::ValuesIn([] {
                           std::vector<std::string> ids;
                           for (const fs::directory_entry& file : fs::directory_iterator(kSource / "src" / "motor" / "sensors")) {
                             ids.push_back(file.path().stem().string());
                           }
                           return ids;
                         }()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace heatsoak
