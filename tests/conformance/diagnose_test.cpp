// User's view of `heatsoak diagnose`: shipped logs, short logs, and the extended model in another verb.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "program_run.h"
#include "soak_example.h"
#include "support/longest_line.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// The third match is a hold-out run. Which effect is found for how many seeds of this scenario: tests/attribution/soak_scenario_test.cpp.
TEST(Diagnose, AnswersForTheShippedExampleInTextJsonAndPage) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("match_2.csv"), log("bench.csv"),
                               "--holdout", log("match_3.csv"), "--out", "found", "--json", "-"},
                              in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const nlohmann::json answer = done.json();
  EXPECT_EQ(answer["schema"], "heatsoak.diagnosis/1");
  ASSERT_EQ(answer["verdict"] == "effect_found", !answer["effects"].empty()) << done.out;
  const std::string page = content_of(folder.path() / "found/diagnosis.html");
  const std::string extended = content_of(folder.path() / "found/maxon_ec45_flat_70w_24v.toml");
  EXPECT_LE(longest_line(extended), 160U);
  for (const nlohmann::json& effect : answer["effects"]) {
    for (const char* key : {"node", "parameters", "heat_W", "evidence", "confusable_with"}) {
      EXPECT_TRUE(effect.contains(key)) << key;
    }
    const double probability = effect["evidence"]["probability"].get<double>();
    EXPECT_TRUE(probability > 0.0 && probability <= 1.0) << probability;
    EXPECT_THAT(page, HasSubstr(effect["id"].get<std::string>()));
    EXPECT_THAT(extended, HasSubstr("[effects." + effect["id"].get<std::string>()));
  }
  for (const char* signal : {"winding_C", "stator_C"}) {
    for (const char* model : {"before", "after"}) {
      EXPECT_GT(answer[model]["holdout"][signal]["rmse_K"].get<double>(), 0.0) << model << signal;
    }
  }
  // Text and JSON state the band that the file has for forecasts.
  const nlohmann::json& band = answer["forecast_band"];
  ASSERT_TRUE(band.is_object()) << done.out;
  EXPECT_EQ(band["recordings"], 3);
  for (const char* signal : {"winding_C", "stator_C"}) {
    EXPECT_GT(band["half_width_K"][signal].get<double>(), 0.1) << signal;
    EXPECT_LT(band["half_width_K"][signal].get<double>(), 3.0) << signal;
  }
  EXPECT_THAT(answer["description"].get<std::string>(), HasSubstr("from predictions of 3 left-out recordings"));
  for (const char* key : {"residual_tests", "description"}) {
    EXPECT_TRUE(answer.contains(key)) << key;
  }
  const ProgramRun used = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--model",
                               "found/maxon_ec45_flat_70w_24v.toml", "--samples", "0"},
                              in(folder));
  EXPECT_LE(used.exit_code, 1) << used.err;
}

// The hold-out file has the name of a fitted file in another folder.
TEST(Diagnose, NamesOfHeldOutFilesDoNotChangeTheModel) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "other");
  std::filesystem::copy_file(kSoak / "match_3.csv", folder.path() / "other/match_1.csv");
  std::vector<std::string> models;
  for (const std::string& holdout : {log("match_3.csv"), (folder.path() / "other/match_1.csv").string()}) {
    const std::string out = "found" + std::to_string(models.size());
    const ProgramRun done = run(
        {"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("bench.csv"), "--holdout", holdout, "--out", out}, in(folder));
    ASSERT_EQ(done.exit_code, 0) << done.err;
    models.push_back(content_of(folder.path() / out / (std::string(kMotor) + ".toml")));
  }
  EXPECT_EQ(models[0], models[1]);
}

TEST(Diagnose, SaysThatAHoldoutRunWasFitted) {
  const TemporaryFolder folder;
  const ProgramRun fitted =
      run({"calibrate", "--motor", kMotor, log("match_1.csv"), log("match_2.csv"), "--out", "fitted.toml"}, in(folder));
  ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
  const auto notes_with = [&](const char* holdout) {
    const ProgramRun done =
        run({"diagnose", "--model", "fitted.toml", "--train", log("match_3.csv"), "--holdout", log(holdout), "--explain"}, in(folder));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    std::string words = done.out + done.err;
    std::ranges::replace(words, '\n', ' ');
    return words;
  };
  EXPECT_THAT(notes_with("match_1.csv"), testing::HasSubstr("the errors of match_1 are not those of an unseen run"));
  EXPECT_THAT(notes_with("bench.csv"), testing::Not(testing::HasSubstr("not those of an unseen run")));
}

// Too few samples for any curve over a signal must give an answer instead of a crash.
TEST(Diagnose, AnswersOnLogsOfSeconds) {
  for (const char* part : {"@0-1%", "@0-2%", "@0-4%"}) {
    const TemporaryFolder folder;
    const ProgramRun done =
        run({"diagnose", "--model", kMotor, "--train", log("bench.csv") + part, "--out", "found", "--json", "-"}, in(folder));
    EXPECT_THAT(done.exit_code, testing::AnyOf(0, 3)) << part << done.err;
    EXPECT_THAT(done.json().value("verdict", "an error"), testing::Not("effect_found")) << part;
  }
}

/// Writes the shipped log with changed cells in every line; line 0 is the header.
std::string changed_log(const TemporaryFolder& folder, const std::string& name,
                        const std::function<void(int line, std::vector<std::string>& cells)>& change) {
  std::istringstream logged(content_of(kSoak / name));
  std::string text, line;
  for (int number = 0; std::getline(logged, line); ++number) {
    std::vector<std::string> cells;
    std::istringstream of_line(line);
    for (std::string cell; std::getline(of_line, cell, ',');) {
      cells.push_back(cell);
    }
    change(number, cells);
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  const fs::path file = folder.path() / name;
  std::ofstream(file) << text;
  return file.string();
}
constexpr std::size_t kCurrent = 4;  // columns: time_s, winding_C, stator_C, ambient_C, current_A, speed_rad_per_s

/// Writes match_3 with temperature rises that are `ratio` times the measured ones.
std::string with_rises(const TemporaryFolder& folder, double ratio) {
  std::map<std::size_t, double> first_C;
  return changed_log(folder, "match_3.csv", [&](int line, std::vector<std::string>& cells) {
    for (const std::size_t column : {1, 2}) {
      if (line > 0 && !cells[column].empty()) {
        const double value_C = std::stod(cells[column]);
        const double start_C = first_C.emplace(column, value_C).first->second;
        cells[column] = fmt::format("{:.6f}", start_C + ratio * (value_C - start_C));
      }
    }
  });
}

/// A hold-out run must not influence the result. Here its rises are too small or too large.
TEST(Diagnose, HoldoutRunsOnlyScore) {
  std::string model, calibrated;
  nlohmann::json decided;
  std::map<double, double> error_K;
  for (const double ratio : {1.0, 0.5, 1.3, 1.5}) {
    const TemporaryFolder folder;
    const std::string holdout = with_rises(folder, ratio);
    const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("match_2.csv"), log("bench.csv"),
                                 "--holdout", holdout, "--out", "found", "--as-is", "--json", "-"},
                                in(folder));
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json answer = done.json();
    error_K[ratio] = answer["after"]["holdout"]["winding_C"]["rmse_K"].get<double>();
    const nlohmann::json now{answer["verdict"], answer["effects"], answer["after"]["train"], answer["refused"], answer["ladder"]};
    const ProgramRun fitted =
        run({"calibrate", "--motor", kMotor, "--out", "model.toml", log("match_1.csv"), log("bench.csv"), "--as-is", "--holdout", holdout},
            in(folder));
    ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
    if (ratio == 1.0) {
      decided = now;
      model = content_of(folder.path() / fmt::format("found/{}.toml", kMotor));
      calibrated = content_of(folder.path() / "model.toml");
      continue;
    }
    EXPECT_EQ(now, decided) << ratio;
    EXPECT_EQ(content_of(folder.path() / fmt::format("found/{}.toml", kMotor)), model) << ratio;
    EXPECT_EQ(content_of(folder.path() / "model.toml"), calibrated) << ratio;
    EXPECT_GT(error_K[ratio], 3.0 * error_K[1.0]) << ratio;
  }
}

// If a motor warms by 60 K at a current of 0 A, no missing effect can explain it.
// All three files are scored by the function of `predict`, run by run. The summary takes all three numbers from the same run.
TEST(Diagnose, ScoresEachHoldoutRunWithThreeFilesAlike) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("bench.csv"), "--holdout",
                               log("match_2.csv"), log("match_3.csv"), "--out", "found", "--json", "-"},
                              in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const nlohmann::json answer = done.json();
  const nlohmann::json& runs = answer["runs"]["holdout"];
  const nlohmann::json predicted =
      run({"predict", "--model", "found/" + std::string(kMotor) + ".toml", log("match_2.csv"), log("match_3.csv"), "--json", "-"},
          in(folder))
          .json();
  constexpr double kRounding_K = 1e-3;  // a motor file rounds its values
  for (const char* signal : {"winding_C", "stator_C"}) {
    double worst_K = 0.0;
    for (std::size_t r = 0; r < 2; ++r) {
      const double after_K = runs["after"][r]["error"][signal]["rmse_K"].get<double>();
      EXPECT_NEAR(after_K, predicted["runs"][r]["error"][signal]["rmse_K"].get<double>(), kRounding_K) << signal << r;
      EXPECT_NEAR(runs["after"][r]["coverage_90"][signal].get<double>(), predicted["runs"][r]["coverage_90"][signal].get<double>(), 1e-3)
          << signal << r;
      worst_K = std::max(worst_K, after_K);
    }
    EXPECT_EQ(answer["after"]["holdout"][signal]["rmse_K"].get<double>(), worst_K) << signal;
    double worst_train_K = 0.0;
    for (const nlohmann::json& each : answer["runs"]["train"]) {
      worst_train_K = std::max(worst_train_K, each["error"][signal]["rmse_K"].get<double>());
    }
    EXPECT_EQ(answer["after"]["train"][signal]["rmse_K"].get<double>(), worst_train_K) << signal;
    for (const char* model : {"before", "refitted", "after"}) {
      for (const nlohmann::json& each : runs[model]) {
        if (each["name"] == answer["holdout_run"][signal]) {
          EXPECT_EQ(answer[model]["holdout"][signal]["rmse_K"], each["error"][signal]["rmse_K"]) << model << signal;
        }
      }
    }
  }
}

/// Four times the logged current: the temperatures of every model diverge in the hold-out run.
TEST(Diagnose, AHoldoutRunThatDivergesHasNoScoreAndPreventsNoModel) {
  const TemporaryFolder folder;
  const std::string holdout = changed_log(folder, "match_3.csv", [](int line, std::vector<std::string>& cells) {
    cells[kCurrent] = line > 0 ? std::to_string(4.0 * std::stod(cells[kCurrent])) : cells[kCurrent];
  });
  const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), "--holdout", holdout, log("bench.csv"),
                               "--out", "found", "--as-is", "--json", "-"},
                              in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(fs::exists(folder.path() / fmt::format("found/{}.toml", kMotor)));
  EXPECT_THAT(done.json()["warnings"].dump(), HasSubstr("match_3 has no score"));
  EXPECT_EQ(done.json()["holdout_run"]["winding_C"], "bench");
  const ProgramRun fitted =
      run({"calibrate", "--motor", kMotor, log("match_1.csv"), "--holdout", holdout, "--as-is", "--out", "model.toml"}, in(folder));
  ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
  EXPECT_THAT(fitted.out, HasSubstr("match_3 has no score"));
  EXPECT_TRUE(fs::exists(folder.path() / "model.toml"));
}

TEST(Diagnose, RefusesRunsThatNoExtendedModelFollows) {
  const TemporaryFolder folder;
  const std::string file = changed_log(
      folder, "bench.csv", [](int line, std::vector<std::string>& cells) { cells[kCurrent] = line > 0 ? "0" : cells[kCurrent]; });
  const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", file, "--as-is", "--out", "found"}, in(folder));
  EXPECT_EQ(done.exit_code, 3) << done.out;
  EXPECT_THAT(done.err, HasSubstr("no effect makes the model follow these logs\n  stator_C"));
  EXPECT_FALSE(fs::exists(folder.path() / "found"));
}

// The loss at unlogged speeds correlates with the current. A curve over the current would be a wrong model.
TEST(Diagnose, NamesNoEffectInPlaceOfAnUnloggedSpeed) {
  const TemporaryFolder folder;
  const auto without_speed = [&](const char* name) {
    return changed_log(folder, name, [](int, std::vector<std::string>& cells) { cells.resize(kCurrent + 1); });
  };
  RunOptions wide = in(folder);
  wide.environment.emplace_back("COLUMNS=1000");
  const ProgramRun done = run({"diagnose", "--model", kMotor, "--train", without_speed("match_1.csv"), without_speed("match_2.csv"),
                               without_speed("bench.csv"), "--holdout", without_speed("match_3.csv"), "--json", "-"},
                              wide);
  EXPECT_THAT(done.err, HasSubstr("the loss at speed, up to 5.5 W, is part of the unknown heat"));
  const nlohmann::json answer = done.json();
  for (const nlohmann::json& effect : answer["effects"]) {
    EXPECT_NE(effect["node"], "stator") << effect;
  }
  // Both sensors together, because the unknown split of the loss shifts heat from one to the other.
  const auto error_K = [&](const char* when) {
    const nlohmann::json& of = answer[when]["holdout"];
    return std::hypot(of["winding_C"]["rmse_K"].get<double>(), of["stator_C"]["rmse_K"].get<double>());
  };
  EXPECT_LT(error_K("after"), error_K("before"));
}

TEST(Diagnose, TakesALogWithoutSpeedBesideOthers) {
  const TemporaryFolder folder;
  const auto without_speed = [&](const char* name) {
    return changed_log(folder, name, [](int, std::vector<std::string>& cells) { cells.resize(kCurrent + 1); });
  };
  const ProgramRun fitted =
      run({"diagnose", "--model", kMotor, "--train", without_speed("match_1.csv"), log("bench.csv"), "--explain"}, in(folder));
  EXPECT_EQ(fitted.exit_code, 0) << fitted.err;
  EXPECT_THAT(fitted.out, HasSubstr("not every log has a speed"));
  const ProgramRun held_out =
      run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("bench.csv"), "--holdout", without_speed("match_3.csv")},
          in(folder));
  EXPECT_EQ(held_out.exit_code, 0) << held_out.err;
}

TEST(Diagnose, NamesTheLogUnderWhichTheModelRunsAway) {
  const TemporaryFolder folder;
  const std::string file = changed_log(folder, "match_3.csv", [](int line, std::vector<std::string>& cells) {
    cells[kCurrent] = line > 0 ? fmt::format("{}", 30.0 * std::stod(cells[kCurrent])) : cells[kCurrent];
  });
  const ProgramRun done =
      run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("bench.csv"), file, "--as-is"}, in(folder));
  EXPECT_EQ(done.exit_code, 4) << done.out;
  EXPECT_THAT(done.err, HasSubstr("match_3: the simulated temperature leaves"));
  EXPECT_THAT(done.err, HasSubstr("check the units of the log's columns"));
}

// The second half of a log may start with the whole motor at 68 °C and get warmer. In a whole log this would indicate room temperature in
// degrees Fahrenheit.
TEST(Diagnose, TakesAHotHalfOfASoundLog) {
  const TemporaryFolder folder;
  const auto warm_by_half = [&](bool in_fahrenheit) {
    return changed_log(folder, "bench.csv", [&](int line, std::vector<std::string>& cells) {
      constexpr int kHalf = 900;
      if (line > kHalf) {
        cells[1] = cells[2] = fmt::format("{:.1f}", 68.0 + 8.0 * (1.0 - std::exp((kHalf - line) / 300.0)));
      }
      for (std::size_t column = 1; line > 0 && in_fahrenheit && column <= 3; ++column) {
        cells[column] = cells[column].empty() ? "" : fmt::format("{}", 32.0 + 1.8 * std::stod(cells[column]));
      }
    });
  };
  const auto diagnosed_with_holdout = [&](const std::string& file) {
    return run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("match_2.csv"), file + "@50-100%", "--json", "-"},
               in(folder));
  };
  const ProgramRun sound = diagnosed_with_holdout(warm_by_half(false));
  EXPECT_THAT(sound.err, testing::Not(HasSubstr("in degrees Fahrenheit (")));
  const ProgramRun wrong = diagnosed_with_holdout(warm_by_half(true));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("in degrees Fahrenheit ("));
}

TEST(Diagnose, LeavesNoFolderWhereAnOutputCannotBeWritten) {
  const TemporaryFolder folder;
  const ProgramRun done =
      run({"diagnose", "--model", kMotor, "--train", log("bench.csv"), "--out", "deep/found", "--json", "no/such/answer.json"}, in(folder));
  EXPECT_EQ(done.exit_code, 2) << done.out;
  EXPECT_FALSE(fs::exists(folder.path() / "deep"));
}

TEST(Diagnose, RefusesAnEmptyName) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--out", ""}, {"--json="}}) {
    std::vector<std::string> line{"diagnose", "--model", kMotor, "--train", log("bench.csv")};
    line.insert(line.end(), words.begin(), words.end());
    const ProgramRun done = run(line, in(folder));
    EXPECT_EQ(done.exit_code, 2) << done.out;
    EXPECT_THAT(done.err, HasSubstr(fmt::format("the value of {} is empty", words.front().substr(0, words.front().find('=')))));
  }
}

}  // namespace
}  // namespace heatsoak
