// User's view of `heatsoak calibrate`: shipped logs, damaged logs, and its output file in all other verbs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "program_run.h"
#include "soak_example.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

using CsvCells = std::vector<std::string>;

/// Returns a shipped log with changed rows: time_s, winding_C, stator_C, ambient_C, current_A, speed_rad_per_s.
std::string damaged_log(const std::function<void(std::vector<CsvCells>&)>& change, const char* log = "match_1.csv") {
  std::istringstream lines(content_of(kSoak / log));
  std::string line;
  std::getline(lines, line);
  std::string text = line + '\n';
  std::vector<CsvCells> rows;
  while (std::getline(lines, line)) {
    CsvCells cells;
    std::istringstream in(line + ',');
    for (std::string cell; std::getline(in, cell, ',');) {
      cells.push_back(cell);
    }
    rows.push_back(std::move(cells));
  }
  change(rows);
  for (const CsvCells& cells : rows) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += (i > 0 ? "," : "") + cells[i];
    }
    text += '\n';
  }
  return text;
}

std::function<void(std::vector<CsvCells>&)> each_cell(std::size_t column, const std::function<std::string(double)>& change) {
  return [=](std::vector<CsvCells>& rows) {
    for (CsvCells& cells : rows) {
      cells[column] = cells[column].empty() ? "" : change(std::stod(cells[column]));
    }
  };
}

std::function<void(std::vector<CsvCells>&)> time_in(double unit_s) {
  return each_cell(0, [unit_s](double time_s) { return fmt::format("{:.9g}", time_s / unit_s); });
}

struct BadLog {
  const char* name;
  std::function<void(std::vector<CsvCells>&)> change;
  int exit_code;
  const char* message;
};

RunOptions in(const fs::path& folder) {
  RunOptions options;
  options.folder = folder;
  return options;
}

class BadLogs : public testing::TestWithParam<BadLog> {};

TEST_P(BadLogs, AreRefusedWithTheReason) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", damaged_log(GetParam().change));
  const ProgramRun found = run({"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, GetParam().exit_code) << found.err;
  EXPECT_THAT(found.err, HasSubstr("log.csv"));
  EXPECT_THAT(found.err, HasSubstr(GetParam().message));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"log.csv"});
}

INSTANTIATE_TEST_SUITE_P(
    All, BadLogs,
    testing::Values(BadLog{"FahrenheitColumn", each_cell(1, [](double winding_C) { return std::to_string(1.8 * winding_C + 32.0); }), 2,
                           "in degrees Fahrenheit"},
                    BadLog{"Kelvin", each_cell(2, [](double stator_C) { return std::to_string(stator_C + 273.15); }), 2, "in kelvin"},
                    BadLog{"Milliamps", each_cell(4, [](double current_A) { return std::to_string(1e3 * current_A); }), 2,
                           "in milliamperes"},
                    BadLog{"SmallMilliamps", each_cell(4, [](double current_A) { return std::to_string(30.0 * current_A); }), 2,
                           "is it in milliamperes"},
                    BadLog{"ConstantCurrent", each_cell(4, [](double) { return "3"; }), 2, "current_A is constant, 3 A, while winding_C"},
                    BadLog{"Minutes", time_in(60.0), 2, "is the time in minutes"},
                    BadLog{"Hours", time_in(3600.0), 2, "is the time in hours"},
                    BadLog{"SwappedSensors",
                           [](std::vector<CsvCells>& rows) {
                             for (CsvCells& cells : rows) {
                               std::swap(cells[1], cells[2]);
                             }
                           },
                           2, "are the two swapped?"},
                    BadLog{"AllConstant",
                           [](std::vector<CsvCells>& rows) {
                             for (CsvCells& cells : rows) {
                               std::copy(rows.front().begin() + 1, rows.front().end(), cells.begin() + 1);
                             }
                           },
                           3, "winding_C is constant"},
                    BadLog{"TooShort", [](std::vector<CsvCells>& rows) { rows.resize(12); }, 3, "12 rows; at least 20"},
                    BadLog{"Unexcited",
                           [](std::vector<CsvCells>& rows) {
                             for (std::size_t row = 0; row < rows.size(); ++row) {
                               rows[row][1] = std::to_string(22.0 + 0.1 * static_cast<double>(row * 7 % 5));
                               rows[row][2] = std::to_string(22.0 + 0.1 * static_cast<double>(row * 11 % 5));
                               rows[row][4] = rows[row][5] = "0";
                             }
                           },
                           3, "no heat input"},
                    BadLog{"NothingButNan",
                           [](std::vector<CsvCells>& rows) {
                             for (CsvCells& cells : rows) {
                               std::fill(cells.begin() + 1, cells.end(), "NaN");
                             }
                           },
                           3, "contains a number"},
                    BadLog{"BlankCurrent",
                           [](std::vector<CsvCells>& rows) {
                             for (CsvCells& cells : rows) {
                               cells[4] = "nan";
                             }
                           },
                           2, "is missing in this log or has no valid value"},
                    BadLog{"NoTemperatures",
                           [](std::vector<CsvCells>& rows) {
                             for (CsvCells& cells : rows) {
                               cells[1] = cells[2] = "";
                             }
                           },
                           3, "no temperature of the motor"},
                    BadLog{"Unsorted", [](std::vector<CsvCells>& rows) { std::ranges::reverse(rows); }, 2, "time does not increase"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Calibrate, LogsThatLookWrongAreTakenAsTheyAreWhereAsked) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", damaged_log(each_cell(5, [](double speed) { return std::to_string(9.55 * speed); })));
  EXPECT_EQ(run({"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml"}, in(folder.path())).exit_code, 2);
  const ProgramRun found = run({"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml", "--as-is"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("log: speed_rad_per_s reaches"));
}

TEST(Calibrate, OneLogDoesNotCountTwiceNorTestItself) {
  const TemporaryFolder folder;
  const std::string log = (kSoak / "match_1.csv").string();
  write(folder.path() / "copy.csv", damaged_log(each_cell(0, [](double time_s) { return std::to_string(time_s + 86400.0); })));
  for (const std::vector<std::string>& logs :
       {std::vector<std::string>{log, "copy.csv"}, std::vector<std::string>{log, "--holdout", "copy.csv"}}) {
    std::vector<std::string> arguments{"calibrate", "--motor", kMotor, "--out", "model.toml"};
    arguments.insert(arguments.end(), logs.begin(), logs.end());
    const ProgramRun found = run(arguments, in(folder.path()));
    EXPECT_EQ(found.exit_code, 2);
    EXPECT_THAT(found.err, AllOf(HasSubstr("copy.csv:2:1: error: lines 2 to "), HasSubstr(" share rows with lines 2 to ")));
  }
}

TEST(Calibrate, SlicesOfOneLogThatOverlapAreNamedByTheirLines) {
  const TemporaryFolder folder;
  const std::string log = (kSoak / "match_1.csv").string();
  const ProgramRun found =
      run({"calibrate", "--motor", kMotor, "--out", "model.toml", log + "@0-60%", "--holdout", log + "@40-100%"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err,
              testing::ContainsRegex(R"(match_1\.csv:[0-9]+:1: error: lines [0-9]+ to [0-9]+ share rows with lines 2 to [0-9]+ of)"));
}

TEST(Calibrate, AllBadLogsAreReportedAtOnce) {
  const TemporaryFolder folder;
  write(folder.path() / "no_time.csv", "current_A,winding_C\n1,25\n");
  write(folder.path() / "unclosed.csv", "time_s,current_A,winding_C\n0,1,\"25\n");
  const ProgramRun found = run({"calibrate", "--motor", kMotor, (kSoak / "match_1.csv").string(), "no_time.csv", "--holdout",
                                "unclosed.csv", "missing.csv", "--out", "model.toml"},
                               in(folder.path()));
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err,
              AllOf(HasSubstr("no_time.csv:1:1: error: "), HasSubstr("unclosed.csv:2:1: error: "), HasSubstr("missing.csv: error: ")));
  EXPECT_FALSE(fs::exists(folder.path() / "model.toml"));
}

TEST(Calibrate, RowsCutOutOfALogDoNotTestIt) {
  const TemporaryFolder folder;
  const auto cut = [](std::vector<CsvCells>& rows) { rows.erase(rows.begin() + 1, rows.begin() + 300); };
  const auto on_its_own_clock = [&](std::vector<CsvCells>& rows) {
    cut(rows);
    each_cell(0, [](double time_s) { return std::to_string(time_s - 299.0); })(rows);
  };
  write(folder.path() / "cut.csv", damaged_log(on_its_own_clock));
  const std::string log = (kSoak / "match_1.csv").string();
  const ProgramRun found = run({"calibrate", "--motor", kMotor, "--out", "model.toml", log, "--holdout", "cut.csv"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err, HasSubstr("cut.csv:2:1: error: lines 2 to "));
}

/// For a motor that starts warm, only the large error of every model reveals temperatures in degrees Fahrenheit.
TEST(Calibrate, ModelThatIsTensOfKelvinOffIsRefused) {
  for (const auto& [scale_ratio, exit_code] : {std::pair(1.0, 0), std::pair(2.2, 3)}) {
    const TemporaryFolder folder;
    write(folder.path() / "log.csv", damaged_log(
                                         [scale_ratio = scale_ratio](std::vector<CsvCells>& rows) {
                                           rows.erase(rows.begin(), rows.begin() + 20);
                                           each_cell(1, [=](double winding_C) {
                                             return std::to_string(scale_ratio > 1.0 ? scale_ratio * winding_C + 32.0 : winding_C);
                                           })(rows);
                                           each_cell(2, [](double) { return ""; })(rows);
                                         },
                                         "bench.csv"));
    const ProgramRun found = run({"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml"}, in(folder.path()));
    EXPECT_EQ(found.exit_code, exit_code) << found.err;
    EXPECT_EQ((found.out + found.err).find("degrees Fahrenheit") != std::string::npos, exit_code != 0);
  }
}

/// The numerics work, but the data do not determine the parameters.
TEST(Calibrate, CurrentsThatNoMotorSurvivesAreNoAnswer) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", damaged_log(each_cell(4, [](double current_A) { return std::to_string(10.0 * current_A); })));
  const ProgramRun found = run({"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, 3) << found.err;
  EXPECT_THAT(found.err, HasSubstr("check the units of the heat inputs"));
}

/// The fit reaches parameters beyond which the simulation diverges. The ends of their intervals must be numbers all the same.
TEST(Calibrate, IntervalsEndWhereTheSimulationDiverges) {
  const TemporaryFolder folder;
  Words command{"calibrate", "--motor", kMotor, "--out", "model.toml", "--as-is"};
  for (const char* name : {"match_1.csv", "match_2.csv", "match_3.csv"}) {
    write(folder.path() / name, damaged_log(each_cell(4, [](double) { return "3"; }), name));
    command.emplace_back(name);
  }
  const ProgramRun found = run(command, in(folder.path()));
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.out.find("nan"), std::string::npos) << found.out;
  EXPECT_EQ(content_of(folder.path() / "model.toml").find("nan"), std::string::npos);
}

TEST(Calibrate, WhatIsLeftOutIsSaidWithItsLines) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", damaged_log([](std::vector<CsvCells>& rows) {
          rows.insert(rows.begin() + 10, rows[9]);
          rows[500][1] = "nonsense";
        }));
  const std::string rows = "log: left out: 1 row: time repeated or running backwards; line 12";
  const std::string cells = "log: left out: 1 sample of winding_C: not a number; line 502 (\"nonsense\")";
  RunOptions wide = in(folder.path());
  wide.environment.emplace_back("COLUMNS=1000");
  for (const Words& words :
       {Words{"calibrate", "--motor", kMotor, "log.csv", "--out", "model.toml", "--json", "-", "--explain"},
        Words{"diagnose", "--model", kMotor, "--train", "log.csv@0-60%", "--holdout", "log.csv@60-100%", "--json", "-", "--explain"}}) {
    const ProgramRun found = run(words, wide);
    ASSERT_EQ(found.exit_code, 0) << found.err;
    EXPECT_THAT(found.err, testing::AllOf(HasSubstr("- " + rows), HasSubstr("- " + cells)));
    const auto notes = found.json()["notes"].get<std::vector<std::string>>();
    EXPECT_EQ(std::ranges::count(notes, rows), 1);
    EXPECT_EQ(std::ranges::count(notes, cells), 1);
  }
}

TEST(Calibrate, HeldOutLogsAreLookedAtToo) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", damaged_log(each_cell(4, [](double current_A) { return std::to_string(1e3 * current_A); })));
  const ProgramRun found = run(
      {"calibrate", "--motor", kMotor, (kSoak / "bench.csv").string(), "--holdout", "log.csv", "--out", "model.toml"}, in(folder.path()));
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err, HasSubstr("in milliamperes"));
}

/// Model of the README's example.
class CalibratedModel : public testing::Test {
 protected:
  CalibratedModel() { write(folder_.path() / "measured_motor.toml", example_calibration().motor_file); }
  ProgramRun line(const std::string& text) const { return run_line("heatsoak " + text, in(folder_.path())); }

  const TemporaryFolder folder_;
};

TEST_F(CalibratedModel, AnswersAsTheInterfaceSays) {
  const nlohmann::json& answer = example_calibration().answer;
  EXPECT_EQ(answer["schema"], "heatsoak.calibration/1");
  ASSERT_GE(answer["parameters"].size(), 6U);
  for (const nlohmann::json& each : answer["parameters"]) {
    EXPECT_TRUE(each["name"].is_string());
    EXPECT_TRUE(each["unit"].is_string());
    EXPECT_TRUE(each["identifiable"].is_boolean());
    EXPECT_LE(each["ci95"][0].get<double>(), each["value"].get<double>());
    EXPECT_GE(each["ci95"][1].get<double>(), each["value"].get<double>());
  }
  for (const char* where : {"error", "error_before", "holdout_error", "holdout_error_before"}) {
    for (const char* signal : {"winding_C", "stator_C"}) {
      EXPECT_GT(answer[where][signal]["rmse_K"].get<double>(), 0.0) << where;
      EXPECT_GE(answer[where][signal]["max_abs_K"].get<double>(), answer[where][signal]["rmse_K"].get<double>()) << where;
    }
  }
  for (const char* signal : {"winding_C", "stator_C"}) {
    EXPECT_LT(answer["holdout_error"][signal]["rmse_K"].get<double>(),
              0.6 * answer["holdout_error_before"][signal]["rmse_K"].get<double>());
  }
}

TEST_F(CalibratedModel, IsTheSameForOneSeedWhateverTheNumberOfThreads) {
  const Calibrated again("3");
  EXPECT_EQ(again.motor_file, example_calibration().motor_file);
  EXPECT_EQ(again.answer, example_calibration().answer);
}

TEST_F(CalibratedModel, ForecastsUnderTheNameOfItsMotor) {
  const ProgramRun predicted = line("predict --model measured_motor.toml " + (kSoak / "match_3.csv").string() + " --json -");
  ASSERT_EQ(predicted.exit_code, 0) << predicted.err;
  EXPECT_EQ(predicted.json().at("motor"), "maxon_ec45_flat_70w_24v");
  EXPECT_EQ(predicted.json().at("model"), "measured_motor.toml");
}

TEST_F(CalibratedModel, IsReadByEveryOtherVerb) {
  const std::string motor = "measured_motor.toml";
  EXPECT_EQ(line("lint " + motor).exit_code, 0) << line("lint " + motor).out;
  EXPECT_THAT(line("describe " + motor).out, HasSubstr("fit to measured temperatures"));
  EXPECT_EQ(line("steady --motor " + motor + " --current-on 3A --time-on 10s --time-off 20s").exit_code, 0);
  EXPECT_LE(line("evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors " + motor + " --samples 50").exit_code, 1);
  const ProgramRun evaluated =
      line("evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --model " + motor + " --samples 50 --json -");
  EXPECT_LE(evaluated.exit_code, 1) << evaluated.err;
  EXPECT_EQ(evaluated.json()["schema"], "heatsoak.evaluate/1");
  EXPECT_EQ(line("simulate --motor " + motor + " --robot roboteam_twente_v2024 --duty paper_intermittent --out trace.csv").exit_code, 0);
  const std::string logs = (kSoak / "bench.csv").string() + ' ' + (kSoak / "match_1.csv").string();
  const ProgramRun diagnosed =
      line("diagnose --model " + motor + " --train " + logs + " --holdout " + (kSoak / "match_3.csv").string() + " --out diagnosis");
  EXPECT_EQ(diagnosed.exit_code, 0) << diagnosed.err;
}

/// The written file contains a body that the motor file does not have: no change of a stated value, but nothing to hide either.
TEST(Calibrate, SaysWhatTheWrittenNetworkContainsForForecasts) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments{"calibrate", "--motor", kMotor, "--out", "model.toml"};
  for (const char* log : {"bench.csv", "match_1.csv", "match_2.csv"}) {
    arguments.push_back((kSoak / log).string());
  }
  const ProgramRun found = run(arguments, in(folder.path()));
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("- for better forecasts the network now has body_at_stator"));
  EXPECT_THAT(found.out, testing::Not(HasSubstr("times the value of")));
}

}  // namespace
}  // namespace heatsoak
