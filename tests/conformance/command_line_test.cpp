// Rules for all verbs (interfaces.md). The test finds the verbs in the program's own help.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "motor/motor.h"
#include "program_run.h"
#include "robot/robot.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::UnorderedElementsAre;

const Words kSteady{"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6A", "--time-on", "4s", "--time-off", "6s"};
const Words kEvaluate{"evaluate",
                      "--robot",
                      "roboteam_twente_v2024",
                      "--duty",
                      "paper_intermittent",
                      "--motors",
                      "maxon_ec45_flat_70w_24v, maxon_ecx_flat_32l_48v"};
const Words kSimulate{"simulate", "--motor", "maxon_ec45_flat_70w_24v", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent"};

const fs::path kFrictionLog = kSource / "reports/friction_test/steady_state_test.csv";

/// Returns the verbs that have a reference page. Tests are listed from these names, which need no run of the program.
std::vector<std::string> verbs() {
  std::vector<std::string> names;
  for (const std::string& page : files_of(kSource / "docs" / "reference", "", ".md")) {
    if (page != "README.md") {
      names.push_back(fs::path(page).stem().string());
    }
  }
  return names;
}

/// Returns the verbs that the help lists.
std::vector<std::string> verbs_of_the_help() {
  std::istringstream help(run({"--help"}).out);
  std::vector<std::string> result;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Verbs:") {
      listed = true;
    } else if (listed && line.starts_with("  ") && !line.starts_with("   ")) {
      result.push_back(line.substr(2, line.find(' ', 2) - 2));
    } else if (listed && line.empty()) {
      break;
    }
  }
  return result;
}

TEST(Verbs, have_a_reference_page_each) { EXPECT_THAT(verbs_of_the_help(), testing::UnorderedElementsAreArray(verbs())); }

/// Returns the lines below "Example:" in the help.
std::vector<std::string> examples(const std::string& verb) {
  std::istringstream help(run({verb, "--help"}).out);
  std::vector<std::string> result;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line.starts_with("Example")) {
      listed = true;
    } else if (listed && !result.empty() && result.back().ends_with('\\')) {
      result.back().back() = ' ';
      result.back() += line;
    } else if (listed && line.starts_with("  ")) {
      result.push_back(line.substr(2));
    }
  }
  return result;
}

class Verb : public testing::TestWithParam<std::string> {};

TEST_P(Verb, has_help_on_stdout) {
  for (const char* option : {"--help", "-h"}) {
    const ProgramRun result = run({GetParam(), option});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("Usage: heatsoak " + GetParam()));
  }
}

// The examples must run in any folder, because all files that they need are installed.
TEST_P(Verb, has_an_example_that_runs) {
  const std::vector<std::string> lines = examples(GetParam());
  ASSERT_THAT(lines, Not(IsEmpty()));
  for (const std::string& line : lines) {
    const TemporaryFolder folder;
    RunOptions options;
    options.folder = folder.path();
    options.environment = {"DISPLAY", "WAYLAND_DISPLAY"};
    options.time_limit_s = 280;
    EXPECT_THAT(line, HasSubstr("heatsoak " + GetParam()));
    const ProgramRun result = run_line(line, options);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << line << "\nends with " << result.exit_code << "\n" << result.err;
    EXPECT_THAT(folder.names(), Not(Contains(HasSubstr("partial"))));
    // The example must have written its declared output files.
    std::istringstream words(line);
    std::string before;
    for (std::string word; words >> word; before = word) {
      if (before == "--plot" || before == "--out" || (before == "--json" && word != "-")) {
        EXPECT_TRUE(fs::exists(folder.path() / word)) << word;
      }
    }
  }
}

TEST_P(Verb, suggests_the_option_that_was_meant) {
  const ProgramRun result = run({GetParam(), "--hepl"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("did you mean '--help'?"));
}

TEST_P(Verb, refuses_unknown_words) {
  for (const Words& wrong : {Words{"--surprise"}, Words{"-Q"}, Words{"--surprise=1"}, Words{"a", "b", "c", "d"}}) {
    const ProgramRun result = run(Words{GetParam()} + wrong);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(wrong) << result.out;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, Not(IsEmpty()));
    EXPECT_THAT(result.err, Not(HasSubstr("bug")));
  }
}

TEST_P(Verb, bears_a_full_disk) {
  RunOptions full;
  full.stdout_file = "/dev/full";
  const ProgramRun result = run({GetParam(), "--help"}, full);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("stdout cannot be written"));
}

INSTANTIATE_TEST_SUITE_P(help, Verb, testing::ValuesIn(verbs()), [](const auto& instance) { return test_name(instance.param); });

// One test for every file of the data folders.

struct DataFile {
  std::string kind;  ///< name of the kind in `list`
  fs::path file;
};

class Data : public testing::TestWithParam<DataFile> {};

TEST_P(Data, loads_is_sound_and_is_described) {
  const auto& [kind, file] = GetParam();
  const ProgramRun lint = run({"lint", file.string()});
  EXPECT_EQ(lint.exit_code, 0) << lint.out << lint.err;
  const ProgramRun description = run({"describe", file.stem().string(), "--json", "-"});
  EXPECT_EQ(description.exit_code, 0) << description.err;
  EXPECT_EQ(description.json().at("id"), file.stem().string());
}

TEST_P(Data, is_evaluated) {
  const auto& [kind, file] = GetParam();
  const ProgramRun result = run({"evaluate", "--motors", kind == "motors" ? file.string() : "maxon_ec45_flat_70w_24v", "--robot",
                                 kind == "robots" ? file.string() : "roboteam_twente_v2024", "--duty",
                                 kind == "duties" ? file.string() : "paper_intermittent", "--samples", "3", "--json", "-"});
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
  EXPECT_EQ(result.json().at("motors").size(), 1U);
}

std::vector<DataFile> data_files() {
  std::vector<DataFile> all;
  for (const auto& [kind, folder] :
       {std::pair{"motors", kSource / "motor_db"}, {"robots", kSource / "robot_core" / "robots"}, {"duties", kSource / "duty_profiles"}}) {
    for (const std::string& name : files_of(folder, "", ".toml")) {
      all.push_back({kind, folder / name});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(folders, Data, testing::ValuesIn(data_files()),
                         [](const auto& instance) { return test_name(instance.param.file.filename().string()); });

TEST(List, shows_every_file_of_the_data_folders) {
  for (const DataFile& each : data_files()) {
    const json items = run({"list", each.kind, "--json", "-"}).json().at("items");
    EXPECT_TRUE(std::ranges::any_of(items, [&](const json& item) { return item.at("id") == each.file.stem().string(); })) << each.file;
  }
}

TEST(List, effects_and_formats_are_described) {
  for (const char* kind : {"effects", "formats"}) {
    EXPECT_THAT(run({"list", kind, "--json", "-"}).json().at("items"), Not(IsEmpty()));
  }
  const json effects = run({"list", "effects", "--json", "-"}).json();
  for (const json& item : effects.at("items")) {
    EXPECT_EQ(run({"describe", item.at("id")}).exit_code, 0) << item;
  }
}

TEST(List, formats_name_the_importers_of_games) {
  const ProgramRun formats = run({"list", "formats"});
  EXPECT_THAT(formats.out, HasSubstr("ssl_log "));
  EXPECT_THAT(formats.out, HasSubstr("duty --import LOG"));
}

TEST(Lint, takes_files_folders_and_ids_of_every_kind) {
  const fs::path motors = kSource / "motor_db";
  const json of_folder = run({"lint", motors.string(), "--json", "-"}).json();
  EXPECT_EQ(of_folder.at("files").size(), files_of(motors, "", ".toml").size());
  EXPECT_EQ(of_folder.at("errors"), 0);
  EXPECT_EQ(of_folder.at("warnings"), 0);
  const json of_ids = run({"lint", "maxon_dcx19s_24v", "tigers_v2020", "paper_intermittent", "--json", "-"}).json();
  EXPECT_EQ(of_ids.at("files"), json({motors / "maxon_dcx19s_24v.toml", kSource / "robot_core/robots/tigers_v2020.toml",
                                      kSource / "duty_profiles/paper_intermittent.toml"}));
}

TEST(Lint, motors_that_reports_begin_with_are_sound) {
  for (const char* each : {"reports/calibration/lea_pmsm_52kw.toml", "reports/calibration/p80.toml", "reports/calibration/ri50.toml",
                           "reports/diagnosis/uav_motor.toml", "tests/data/motors/robotino_motor.toml"}) {
    EXPECT_EQ(run({"lint", (kSource / each).string(), "--json", "-"}).json().at("errors"), 0) << each;
  }
}

TEST(Lint, fails_for_errors_and_for_warnings) {
  const fs::path data = kSource / "tests/data/lint_motors";
  const ProgramRun wrong = run({"lint", (data / "lint_df45l_wiki.toml").string()});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.out, HasSubstr(": error: density: 320 g"));
  EXPECT_THAT(wrong.out, HasSubstr(": warning: nominal_point_heat: "));
  const TemporaryFolder folder;
  std::string undecided = content_of(kSource / "motor_db" / "nanotec_df45l024048_a2.toml");
  undecided.replace(undecided.find("\"27 mm\""), 7, "\"48 mm\"");
  write(folder.path() / "doubtful.toml", undecided);
  const ProgramRun warned = run({"lint", (folder.path() / "doubtful.toml").string()});
  EXPECT_EQ(warned.exit_code, 1);
  EXPECT_THAT(warned.out, HasSubstr("1 file: 0 errors, 1 warning\n"));
}

/// A motor file of the DF45L with one parameter value from a wiki and without its other sources.
class WikiValueOfDf45l : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(WikiValueOfDf45l, is_caught) {
  const auto& [sound, wiki] = GetParam();
  const TemporaryFolder folder;
  std::string text = content_of(kSource / "motor_db" / "nanotec_df45l024048_a2.toml");
  text = std::regex_replace(text, std::regex("confirmed_by = \\{[^}]*\\}, "), "");
  const std::size_t at = text.find(sound);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, sound.size(), wiki);
  write(folder.path() / "df45l.toml", text);
  const ProgramRun lint = run({"lint", (folder.path() / "df45l.toml").string()});
  EXPECT_EQ(lint.exit_code, 1) << lint.out << lint.err;
}

INSTANTIATE_TEST_SUITE_P(
    each, WikiValueOfDf45l,
    testing::Values(std::pair{"nominal_current = { value = \"3.26 A\"", "nominal_current = { value = \"6.4 A\""},
                    std::pair{"\"65 W\"", "\"151 W\""}, std::pair{"\"0.64 ohm\"", "\"1.2 ohm\""},
                    std::pair{"\"150 g\", origin = \"estimated\", source = [\"own\", \"maxon_2019\"], range = [\"120 g\", \"180 g\"]",
                              "\"320 g\", origin = \"third_party\", source = \"own\", tolerance = \"5 %\""},
                    std::pair{"\"27 mm\"", "\"48 mm\""},
                    std::pair{"\"181 g cm2\", origin = \"estimated\", source = [\"own\", \"maxon_2019\"], range = "
                              "[\"120 g cm2\", \"250 g cm2\"]",
                              "\"13 g cm2\", origin = \"third_party\", source = \"own\", tolerance = \"10 %\""}),
    [](const auto& instance) { return "figure_" + std::to_string(instance.index); });

/// The output of `describe` must be valid when it is pasted into a motor file.
class EffectLines : public testing::TestWithParam<std::string> {};

TEST_P(EffectLines, make_a_motor_file_that_runs) {
  const std::string text = run({"describe", GetParam()}).out;
  const std::size_t mark = text.find("\nat the end of a motor file");
  ASSERT_NE(mark, std::string::npos) << text;
  const TemporaryFolder folder;
  const fs::path motor = folder.path() / "motor.toml";
  write(motor, content_of(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml") + "\n" + text.substr(text.find('\n', mark + 1) + 1));
  const ProgramRun lint = run({"lint", motor.string()});
  const bool is_doubled = GetParam() == "copper_loss" || GetParam() == "no_load_loss";
  EXPECT_EQ(lint.exit_code, is_doubled ? 1 : 0) << lint.out << lint.err << text;
  EXPECT_EQ(lint.out.find("counts twice") != std::string::npos, is_doubled) << lint.out;
  const ProgramRun evaluated = run({"evaluate", "--motors", motor.string(), "--robot", "roboteam_twente_v2024", "--duty",
                                    "paper_intermittent", "--samples", "8", "--json", "-"});
  EXPECT_TRUE(evaluated.exit_code == 0 || evaluated.exit_code == 1) << evaluated.err;
  EXPECT_EQ(evaluated.json().at("motors").at(0).at("data_quality"), "estimated");
  const ProgramRun result =
      run({"simulate", "--motor", motor.string(), "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--json", "-"});
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
  EXPECT_TRUE(std::ranges::any_of(result.json().at("balance"), [](const json& row) { return row.at("effect") == "my_" + GetParam(); }));
}

INSTANTIATE_TEST_SUITE_P(catalogue, EffectLines, testing::ValuesIn([] {
                           std::vector<std::string> ids;
                           for (const std::string& file : files_of(kSource / "src" / "thermal" / "effects", "", ".cpp")) {
                             ids.push_back(fs::path(file).stem().string());
                           }
                           return ids;
                         }()),
                         [](const auto& instance) { return instance.param; });

TEST(ExitCode, says_whether_a_limit_is_exceeded) {
  EXPECT_EQ(run(kSteady).exit_code, 0);
  EXPECT_EQ(run({"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "30", "--time-on", "1", "--time-off", "0"}).exit_code, 1);
  EXPECT_EQ(run(kEvaluate + Words{"--samples", "0"}).exit_code, 1);  // the paper's motor exceeds its limit
}

void expect_number_or_null(const json& value, const std::string& key) {
  EXPECT_TRUE(value.at(key).is_number() || value.at(key).is_null()) << key;
}

TEST(Json, of_steady_keeps_the_contract) {
  const ProgramRun result = run(kSteady + Words{"--json", "-"});
  const json answer = result.json();
  EXPECT_EQ(answer.at("schema"), "heatsoak.steady/1");
  for (const char* key : {"current_rms_A", "winding_C", "stator_C"}) {
    EXPECT_TRUE(answer.at(key).is_number()) << key;
  }
  EXPECT_EQ(answer.at("runaway"), false);
  EXPECT_THAT(result.err, HasSubstr("winding"));  // the report for people goes to stderr
}

Words steady(const std::string& motor, const std::string& current_on, const std::string& time_on, const std::string& time_off) {
  return {"steady", "--motor", motor, "--current-on", current_on, "--time-on", time_on, "--time-off", time_off, "--json", "-"};
}

TEST(Steady, mean_of_a_long_cycle_is_that_of_the_network) {
  const json answer = run(steady("maxon_ecx_flat_32l_48v", "5A", "300s", "900s")).json();
  EXPECT_GT(answer.at("winding_mean_C"), answer.at("winding_C").get<double>() + 30.0);
  EXPECT_GT(answer.at("winding_peak_C"), answer.at("winding_mean_C"));
  const json brief = run(steady("maxon_ecx_flat_32l_48v", "5A", "0.3s", "0.9s")).json();
  EXPECT_NEAR(brief.at("winding_mean_C"), brief.at("winding_C"), 0.05);
  EXPECT_EQ(brief.at("winding_C"), answer.at("winding_C"));
}

TEST(Steady, phases_of_an_hour_are_no_failure) {
  const ProgramRun result = run(steady("maxon_ec45_flat_70w_24v", "6A", "1h", "1h"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NEAR(result.json().at("winding_peak_C"), 509.2, 0.5);
}

TEST(Steady, destroyed_within_one_time_on_is_a_runaway) {
  const ProgramRun result = run(steady("maxon_ec45_flat_70w_24v", "20A", "100s", "100000s"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.json().at("runaway"), true);
  EXPECT_TRUE(result.json().at("winding_peak_C").is_null());
  EXPECT_LT(result.json().at("destroyed_after_s"), 100.0);
  EXPECT_THAT(result.err, testing::ContainsRegex("1000[ \n]°C[ \n]are[ \n]exceeded"));
}

// The closed-form solution does not include the additional node of an effect.
TEST(Steady, with_effects_mean_and_peak_are_of_one_network) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "mine.toml";
  write(file, content_of(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml") +
                  "\n[effects.third_node]\nnode = \"stator\"\n"
                  "conductance = { value = \"0.2 W/K\", origin = \"estimated\", derivation = \"x\" }\n"
                  "leak_ratio = { value = \"0.3\", origin = \"estimated\", derivation = \"x\" }\n"
                  "heat_capacity = { value = \"3000 J/K\", origin = \"estimated\", derivation = \"x\" }\n");
  double shorter_C = 0.0;
  double brief_C = 0.0;
  for (const auto& [on, off] : {std::pair("0.04s", "0.06s"), std::pair("0.4s", "0.6s"), std::pair("4s", "6s"), std::pair("40s", "60s")}) {
    const ProgramRun result = run(steady(file.string(), "6A", on, off));
    ASSERT_NE(result.exit_code, 2) << result.err;
    const json answer = result.json();
    EXPECT_GT(answer.at("winding_peak_C"), answer.at("winding_mean_C")) << on;
    EXPECT_GT(answer.at("winding_peak_C"), shorter_C) << on;
    shorter_C = answer.at("winding_peak_C");
    brief_C = brief_C == 0.0 ? shorter_C : brief_C;
    EXPECT_LT(answer.at("winding_C"), brief_C) << on;
  }
  const json bare = run(steady("maxon_ec45_flat_70w_24v", "6A", "4s", "6s")).json();
  EXPECT_LT(brief_C, bare.at("winding_C")) << "the body leads heat away";
}

TEST(Json, of_friction_keeps_the_contract) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "measured.toml").string();
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", kFrictionLog.string(), "--out", out, "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = result.json();
  EXPECT_EQ(answer.at("schema"), "heatsoak.friction/1");
  ASSERT_EQ(answer.at("wheels").size(), 4U);
  for (const json& wheel : answer["wheels"]) {
    EXPECT_TRUE(wheel.at("index").is_number_unsigned());
    for (const char* key : {"damping_V_s_per_rad", "a_V", "b_V", "phase_rad"}) {
      const json& estimate = wheel.at(key);
      EXPECT_LE(estimate.at("ci95").at(0), estimate.at("value")) << key;
      EXPECT_GE(estimate.at("ci95").at(1), estimate.at("value")) << key;
    }
    EXPECT_GT(wheel.at("r2"), 0.5);
    EXPECT_FALSE(wheel.at("lack_of_fit").get<bool>());
    EXPECT_TRUE(wheel.at("repeats_V").is_number());
    EXPECT_EQ(wheel.at("rows_used").get<int>() + wheel.at("rows_left_out").get<int>(), answer.at("rows").get<int>());
  }
  EXPECT_TRUE(answer.at("before").at("rmse").is_number());
  EXPECT_TRUE(answer.at("after").at("rmse").is_number());
  // The written file must be a robot that all other verbs accept.
  EXPECT_EQ(run({"lint", out}).exit_code, 0);
  EXPECT_THAT(run({"describe", out}).out, HasSubstr("friction test, steady_state_test.csv"));
  const std::string trace = (folder.path() / "trace.csv").string();
  EXPECT_EQ(
      run({"simulate", "--motor", "maxon_ec45_flat_70w_24v", "--robot", out, "--duty", "paper_intermittent", "--out", trace}).exit_code, 0);
  EXPECT_NE(
      run({"evaluate", "--robot", out, "--duty", "paper_intermittent", "--motors", "maxon_ec45_flat_70w_24v", "--samples", "3"}).exit_code,
      2);
}

/// A single roll-out has no scatter, so its fitted parameters have no interval. They must not be reported as given by a file.
TEST(Friction, of_one_roll_out_has_no_intervals_and_is_not_called_given) {
  constexpr double kHeading_rad = 0.1;
  constexpr double kDrag_m_per_s2 = 0.8;
  constexpr double kRate_per_s = 0.5;
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "roll_out.csv").string();
  std::string text = "time_s,battery_V,heading_rad";
  for (int wheel = 1; wheel <= 4; ++wheel) {
    text += fmt::format(",wheel_speed_rad_per_s_{0},wheel_pwm_ratio_{0}", wheel);
  }
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  for (int row = 0; row < 300; ++row) {
    const double free_m_per_s = (1.8 + kDrag_m_per_s2 / kRate_per_s) * std::exp(-kRate_per_s * 0.01 * row) - kDrag_m_per_s2 / kRate_per_s;
    text += fmt::format("\n{:.2f},24,{}", 0.01 * row, kHeading_rad);
    for (const double axis_rad : robot.wheels.axis_rad) {
      const double noise_rad_per_s = 0.05 * std::sin(12.9 * row + 78.2 * axis_rad);
      text += fmt::format(",{:.4f},0",
                          std::max(0.0, free_m_per_s) / robot.wheels.radius_m * std::sin(kHeading_rad - axis_rad) + noise_rad_per_s);
    }
  }
  write(log, text + "\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "--method", "roll_out", log, "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("(no interval)"));
  EXPECT_THAT(result.err, Not(HasSubstr("(given)")));
  const json wheels = result.json().at("wheels");
  for (const json& wheel : wheels) {
    EXPECT_GT(wheel.at("damping_V_s_per_rad").at("value"), 0.0);
    EXPECT_TRUE(wheel.at("damping_V_s_per_rad").at("ci95").at(0).is_null());
  }
}

/// The example with an additional 1.5 V sin 2θ at wheel 2. Columns are time, battery, heading on the field, yaw, then speed and modulation.
TEST(Json, of_friction_says_where_its_law_does_not_hold) {
  std::istringstream log(content_of(kFrictionLog));
  std::string changed;
  for (std::string line; std::getline(log, line); changed += '\n') {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) {
      cells.push_back(cell);
    }
    if (!changed.empty() && cells.size() > 7 && !cells[7].empty() && std::abs(std::stod(cells[7])) > 0.01) {
      const double heading_rad = std::stod(cells[2]) - std::stod(cells[3]);
      cells[7] = fmt::format("{:.5f}", std::stod(cells[7]) + 1.5 * std::sin(2.0 * heading_rad) / std::stod(cells[1]));
    }
    changed += fmt::format("{}", fmt::join(cells, ","));
  }
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", changed);
  RunOptions inside;
  inside.folder = folder.path();
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "log.csv", "--as-is", "--json", "-"}, inside);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = result.json();
  const char* const sentence = "the residual of wheel 2 depends on θ: ";
  EXPECT_THAT(result.err, HasSubstr(sentence));
  EXPECT_THAT(answer.at("findings").get<std::vector<std::string>>(), Contains(HasSubstr(sentence)));
  EXPECT_TRUE(answer.at("wheels").at(1).at("lack_of_fit").get<bool>());
  EXPECT_FALSE(answer.at("wheels").at(0).at("lack_of_fit").get<bool>());
  EXPECT_GT(answer["wheels"][1].at("left_V"), 0.5);
}

TEST(ExitCode, of_friction_refuses_a_log_that_is_given_twice) {
  const TemporaryFolder folder;
  const std::string log = kFrictionLog.string();
  const std::string copy = (folder.path() / "copy.csv").string();
  fs::copy_file(log, copy);
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", log, copy});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("copy.csv:2:1: error: lines 2 to "), HasSubstr(" of " + log)));
}

TEST(ExitCode, of_friction_reports_all_bad_logs_and_writes_nothing) {
  const TemporaryFolder folder;
  write(folder.path() / "few_columns.csv", "time_s,wheel_speed_rad_per_s_1\n0,1\n1,2\n");
  write(folder.path() / "no_time.csv", "wheel_speed_rad_per_s_1\n1\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "few_columns.csv", kFrictionLog.string(), "no_time.csv",
                                 "missing.csv", "--out", "robot.toml"},
                                {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("few_columns.csv:1:1: error: wheel_speed_rad_per_s_2: is missing"),
                                HasSubstr("no_time.csv:1:1: error: "), HasSubstr("missing.csv: error: ")));
  EXPECT_FALSE(fs::exists(folder.path() / "robot.toml"));
}

TEST(ExitCode, of_friction_says_what_a_log_cannot_tell) {
  const TemporaryFolder folder;
  const std::string standing = (folder.path() / "standing.csv").string();
  std::string text = "time_s,battery_V";
  for (const char* wheel : {"1", "2", "3", "4"}) {
    text += std::string(",wheel_speed_rad_per_s_") + wheel + ",wheel_pwm_ratio_" + wheel;
  }
  for (int row = 0; row < 500; ++row) {
    text += fmt::format("\n{:.2f},24,0,0,0,0,0,0,0,0", 0.01 * row);
  }
  write(standing, text + "\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", standing});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("in no interval do the wheels turn steadily"));

  const std::string thermal = (folder.path() / "thermal.csv").string();
  write(thermal, "time_s,winding_C,current_A\n0,25,1\n1,26,1\n2,27,1\n");
  const ProgramRun wrong = run({"friction", "--robot", "roboteam_twente_v2024", thermal});
  EXPECT_EQ(wrong.exit_code, 2);
  for (const char* missing : {"wheel_speed_rad_per_s_1", "wheel_speed_rad_per_s_4"}) {
    EXPECT_THAT(wrong.err, HasSubstr(thermal + ":1:1: error: " + missing + ": is missing"));
  }
}

TEST(Json, of_a_runaway_has_no_temperatures) {
  const ProgramRun result =
      run({"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "60", "--time-on", "1", "--time-off", "0", "--json", "-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.json().at("runaway"), true);
  EXPECT_TRUE(result.json().at("winding_C").is_null());
  EXPECT_TRUE(result.json().at("stator_C").is_null());
}

void expect_evaluate_contract(const json& answer, bool sampled) {
  EXPECT_EQ(answer.at("schema"), "heatsoak.evaluate/1");
  EXPECT_TRUE(answer.at("robot").is_string());
  EXPECT_TRUE(answer.at("duty").is_string());
  EXPECT_TRUE(answer.at("seed").is_number_unsigned());
  ASSERT_TRUE(answer.at("motors").is_array());
  for (const json& motor : answer["motors"]) {
    EXPECT_TRUE(motor.at("id").is_string());
    EXPECT_TRUE(motor.at("winding_limit_C").is_number());
    for (const char* peak : {"winding_peak_C", "stator_peak_C"}) {
      EXPECT_TRUE(motor.at(peak).at("nominal").is_number());
      for (const char* percentile : {"p05", "p50", "p95"}) {
        EXPECT_EQ(motor[peak].at(percentile).is_number(), sampled) << peak << " " << percentile;
      }
    }
    EXPECT_EQ(motor.at("probability_over_limit").is_number(), sampled);
    expect_number_or_null(motor, "time_to_limit_s");
    EXPECT_TRUE(motor.at("current_rms_A").is_number());
    EXPECT_THAT(motor.at("verdict").get<std::string>(), MatchesRegex("pass|marginal|fail|infeasible"));
    EXPECT_THAT(motor.at("limiting_factor").get<std::string>(),
                MatchesRegex("winding_temperature|stator_temperature|voltage|current|none"));
    EXPECT_THAT(motor.at("data_quality").get<std::string>(), MatchesRegex("datasheet|mixed|estimated"));
  }
}

TEST(Json, of_evaluate_keeps_the_contract) {
  const json answer = run(kEvaluate + Words{"--samples", "40", "--seed", "7", "--json", "-"}).json();
  expect_evaluate_contract(answer, true);
  EXPECT_EQ(answer.at("seed"), 7);
  EXPECT_EQ(answer.at("motors").size(), 2U);
}

TEST(Json, of_evaluate_without_samples_has_null_for_what_only_samples_tell) {
  expect_evaluate_contract(run(kEvaluate + Words{"--samples", "0", "--json", "-"}).json(), false);
}

TEST(Json, goes_to_stdout_alone_or_to_its_file) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  const std::vector<Words> lines{kSteady,
                                 kEvaluate + Words{"--samples", "0"},
                                 kSimulate,
                                 {"list", "robots"},
                                 {"describe", "tigers_v2020"},
                                 {"lint", (kSource / "duty_profiles" / "paper_intermittent.toml").string()}};
  for (const Words& words : lines) {
    const ProgramRun on_stdout = run(words + Words{"--json", "-"}, inside);
    const ProgramRun in_file = run(words + Words{"--json=answer.json"}, inside);
    const ProgramRun none = run(words, inside);
    EXPECT_EQ(on_stdout.out, content_of(folder.path() / "answer.json"));
    EXPECT_TRUE(on_stdout.json().at("schema").is_string()) << words[0];
    EXPECT_EQ(on_stdout.err, in_file.out);
    EXPECT_EQ(in_file.out, none.out);
    EXPECT_EQ(in_file.err, "");
    EXPECT_EQ(on_stdout.exit_code, none.exit_code);
    EXPECT_EQ(in_file.exit_code, none.exit_code);
  }
  EXPECT_THAT(folder.names(), UnorderedElementsAre("answer.json"));
}

TEST(Json, reports_errors_of_usage_too) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  for (const Words& wrong :
       {Words{"evaluate"}, Words{"evaluate", "--robt", "x"}, Words{"steady", "--motor", "x", "--current-on", "6V"}, Words{"evalute"},
        Words{"steady", "--motor", "nosuch", "--current-on", "1", "--time-on", "1", "--time-off", "1"}, Words{"list", "\xff"}}) {
    const ProgramRun result = run(wrong + Words{"--json", "-"}, inside);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.json().at("error").at("code"), 2);
    EXPECT_TRUE(result.json().at("error").at("diagnostics").is_array());
    EXPECT_THAT(result.json().at("error").at("message").get<std::string>(), Not(IsEmpty()));
    EXPECT_EQ(run(wrong + Words{"--json", "error.json"}, inside).out, "");
    EXPECT_EQ(json::parse(content_of(folder.path() / "error.json")), result.json());
  }
}

// Random numbers.

TEST(Seed, gives_the_same_bytes_for_any_number_of_threads) {
  const Words sampled = kEvaluate + Words{"--samples", "100", "--seed", "42", "--json", "-"};
  const ProgramRun one = run(sampled + Words{"--threads", "1"});
  for (const char* threads : {"2", "5", "0", "1024"}) {
    const ProgramRun other = run(sampled + Words{"--threads", threads});
    EXPECT_EQ(other.out, one.out) << threads;
    EXPECT_EQ(other.err, one.err) << threads;
  }
  EXPECT_NE(run(kEvaluate + Words{"--samples", "100", "--seed", "43", "--json", "-"}).out, one.out);
}

TEST(Seed, gives_a_motor_the_same_values_beside_any_others) {
  const auto of = [](const std::string& motors) {
    const json answer = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "60", "--json",
                             "-", "--motors", motors})
                            .json();
    for (const json& motor : answer.at("motors")) {
      if (motor.at("id") == "maxon_ec45_flat_70w_24v") {
        return motor;
      }
    }
    return json();
  };
  const json alone = of("maxon_ec45_flat_70w_24v");
  EXPECT_EQ(of("maxon_ecx_flat_32l_48v,maxon_ec45_flat_70w_24v"), alone);
  EXPECT_EQ(of("maxon_ec45_flat_70w_24v,nanotec_df45l024048_a2"), alone);
}

TEST(Usage, evaluate_takes_motor_as_the_other_verbs_do) {
  const Words rest{"--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "0", "maxon_ec45_flat_70w_24v"};
  const auto answer = [&](const std::string& option) {
    Words words{"evaluate"};
    words.insert(words.end(), rest.begin(), rest.end() - 1);
    words.insert(words.end(), {option, rest.back()});
    return run(words);
  };
  EXPECT_EQ(answer("--motor").exit_code, 0);
  EXPECT_EQ(answer("--motor").out, answer("--motors").out);
}

TEST(Usage, version) {
  const ProgramRun result = run({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, MatchesRegex("heatsoak [0-9]+\\.[0-9]+\\.[0-9]+\\+[0-9a-f]{8}\n"));
}

struct Mistake {
  std::string name;
  Words words;
  std::string said;
};
class Usage : public testing::TestWithParam<Mistake> {};

TEST_P(Usage, is_refused_with_a_hint) {
  const ProgramRun result = run(GetParam().words);
  EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    mistakes, Usage,
    testing::Values(
        Mistake{"nothing", {}, "--help"}, Mistake{"unknown_verb", {"evaluat"}, "did you mean 'evaluate'?"},
        Mistake{"far_verb", {"zzzzzzzz"}, "--help"}, Mistake{"empty_verb", {""}, "--help"},
        Mistake{"option_before_verb", {"--db", "/tmp", "list", "motors"}, "--db"},
        Mistake{"unknown_option", kEvaluate + Words{"--sample", "5"}, "did you mean '--samples'?"},
        Mistake{"missing_value", kSteady + Words{"--json"}, "--json"},
        Mistake{"option_twice", kSteady + Words{"--current-on", "5"}, "--current-on is given more than once; expected one value"},
        Mistake{"missing_option", {"steady", "--motor", "maxon_ec45_flat_70w_24v"}, "is required"},
        Mistake{"unknown_kind", {"list", "motor"}, "motors"}, Mistake{"no_kind", {"list"}, "motors, robots, duties, effects, formats"},
        Mistake{"empty_name_of_a_motor",
                {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", ",", "--samples", "0"},
                "a name is missing before or after a comma"},
        Mistake{"lint_of_two_nothings", {"lint", "nosuch.toml", "maxon_foo"}, "nosuch.toml"},
        Mistake{"lint_of_nothing", {"lint", "maxon_ec45_flat_70w_24"}, "did you mean 'maxon_ec45_flat_70w_24v'?"},
        Mistake{"lint_of_an_empty_folder", {"lint", (kSource / "reports").string()}, "there is no .toml file in the folder"},
        Mistake{"unknown_motor",
                {"steady", "--motor", "maxon_ec45_flat_70w_24", "--current-on", "1", "--time-on", "1", "--time-off", "1"},
                "did you mean 'maxon_ec45_flat_70w_24v'?"},
        Mistake{"unknown_robot", {"evaluate", "--robot", "tigers_v2021", "--duty", "paper_intermittent"}, "did you mean 'tigers_v2020'?"},
        Mistake{
            "unknown_duty", {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermitent"}, "did you mean 'paper_intermittent'?"},
        Mistake{"unknown_name", {"describe", "conducton"}, "did you mean 'conduction'?"},
        Mistake{"empty_motor",
                {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", ""},
                "the value of --motors is empty"},
        Mistake{"current_in_volt",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6V", "--time-on", "1", "--time-off", "1"},
                "no unit of this quantity"},
        Mistake{"negative_current",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "-6", "--time-on", "1", "--time-off", "1"},
                "out of range"},
        Mistake{"current_nan",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "nan", "--time-on", "1", "--time-off", "1"},
                "not a finite number"},
        Mistake{"current_1e400",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "1e400", "--time-on", "1", "--time-off", "1"},
                "too large"},
        Mistake{"current_1e200",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "1e200A", "--time-on", "1", "--time-off", "1"},
                "1e200A is out of range; expected 0 A to 100000 A"},
        Mistake{"decimal_comma",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6,5A", "--time-on", "1", "--time-off", "1"},
                "decimal comma"},
        Mistake{"zero_time_on",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6", "--time-on", "0", "--time-off", "1"},
                "out of range"},
        Mistake{"cold_ambient", kSteady + Words{"--ambient", "-300 degC"}, "out of range"},
        Mistake{"negative_samples", kEvaluate + Words{"--samples", "-1"}, "--samples: '-1' is not a whole number from 0 to 1000000"},
        Mistake{"half_samples", kEvaluate + Words{"--samples", "2.5"}, "--samples"},
        Mistake{"too_many_samples", kEvaluate + Words{"--samples", "1000001"}, "--samples"},
        Mistake{"octal_samples", kEvaluate + Words{"--samples", "010"}, "--samples"},
        Mistake{"too_many_threads", kEvaluate + Words{"--threads", "1025"}, "--threads: '1025' is not a whole number from 0 to 1024"},
        Mistake{"negative_seed", kEvaluate + Words{"--seed", "-1"}, "--seed"},
        Mistake{"huge_seed", kEvaluate + Words{"--seed", "99999999999999999999"}, "--seed"},
        Mistake{"every_zero", kSimulate + Words{"--every", "0"}, "out of range"},
        Mistake{"db_missing", {"list", "motors", "--db", "/nonexistent"}, "no such folder"},
        Mistake{"db_is_a_file", {"list", "motors", "--db", "/dev/null"}, "no such folder"},
        Mistake{"db_name_too_long", {"list", "motors", "--db", std::string(5000, 'a')}, "no such folder"},
        Mistake{"motor_name_too_long", {"lint", std::string(5000, 'a') + ".toml"}, "File name too long"}),
    [](const auto& instance) { return instance.param.name; });

TEST(UsageOf, a_trace_that_would_fill_the_memory_is_refused) {
  const TemporaryFolder folder;
  write(folder.path() / "long.toml",
        "summary = \"x\"\norigin = \"x\"\nshape = \"intermittent\"\nambient = { value = \"25 degC\", origin = \"estimated\", derivation = "
        "\"x\" }\n[intermittent]\n"
        "torque_on = { value = \"50 mN m\", origin = \"estimated\", derivation = \"x\" }\nspeed_on = \"40 rad/s\"\ntime_on = \"4 "
        "s\"\ntime_off = \"6 s\"\nrepeats = \"90000\"\n");
  const ProgramRun result = run({"simulate", "--motor", "maxon_ec45_flat_70w_24v", "--robot", "roboteam_twente_v2024", "--duty",
                                 (folder.path() / "long.toml").string(), "--every", "1 ms"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--every"));
  EXPECT_LT(result.memory_MB, 300.0);
}

TEST(UsageOf, negative_temperature_needs_no_quoting) {
  EXPECT_EQ(run(kSteady + Words{"--ambient", "-10degC"}).exit_code, 0);
  EXPECT_EQ(run(kSteady + Words{"--ambient", "-10"}).out, run(kSteady + Words{"--ambient=-10 degC"}).out);
}

// Outputs to places that are not writable.

TEST(Unwritable, one_of_several_outputs_leaves_none_of_them) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  for (const Words& words : {kEvaluate + Words{"--samples", "0", "--plot", "p.svg", "--json", "no_such_folder/a.json"},
                             kSimulate + Words{"--out", "x.csv", "--plot", "no_such_folder/p.svg"},
                             kSimulate + Words{"--out", "same.svg", "--plot", "./same.svg"}}) {
    const ProgramRun result = run(words, inside);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(folder.names(), UnorderedElementsAre());
  }
}

TEST(Unwritable, target_is_reported_and_leaves_nothing) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "taken.svg");
  RunOptions inside;
  inside.folder = folder.path();
  for (const std::string target : {"no_such_folder/x.svg", "taken.svg", "taken.svg/", "/proc/x.svg"}) {
    for (const Words& words : {kSteady + Words{"--json", target}, kEvaluate + Words{"--samples", "0", "--plot", target},
                               kSimulate + Words{"--out", target}, kSimulate + Words{"--plot", target}}) {
      const ProgramRun result = run(words, inside);
      EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(words) << result.err;
      EXPECT_THAT(result.err, testing::AnyOf(HasSubstr("writ"), HasSubstr("end in .svg or .png"))) << target;
      EXPECT_THAT(folder.names(), UnorderedElementsAre("taken.svg")) << target;
    }
  }
  EXPECT_TRUE(fs::is_empty(folder.path() / "taken.svg"));
}

TEST(Unwritable, full_disk_is_reported_and_the_device_survives) {
  RunOptions full;
  full.stdout_file = "/dev/full";
  for (const Words& words : {kSteady, kSteady + Words{"--json", "-"}, Words{"list", "motors"}, Words{"completion"}, Words{"--version"}}) {
    const ProgramRun result = run(words, full);
    EXPECT_EQ(result.exit_code, 2) << words[0] << result.err;
    EXPECT_THAT(result.err, HasSubstr("stdout cannot be written"));
  }
  const ProgramRun result = run(kSteady + Words{"--json", "/dev/full"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("No space left"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(Unwritable, stderr_does_not_crash_it) {
  RunOptions full;
  full.stderr_file = "/dev/full";
  EXPECT_EQ(run({"evaluat"}, full).exit_code, 2);
  EXPECT_EQ(run(kSteady + Words{"--json", "-"}, full).exit_code, 0);
}

TEST(Output, keeps_links_and_devices) {
  const TemporaryFolder folder;
  write(folder.path() / "real.json", "old");
  fs::create_symlink("real.json", folder.path() / "link.json");
  RunOptions inside;
  inside.folder = folder.path();
  EXPECT_EQ(run(kSteady + Words{"--json", "link.json"}, inside).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.json"));
  EXPECT_TRUE(json::parse(content_of(folder.path() / "real.json")).contains("schema"));
  EXPECT_EQ(run(kSteady + Words{"--json", "/dev/null"}, inside).exit_code, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(folder.names(), UnorderedElementsAre("link.json", "real.json"));
}

TEST(Output, of_two_options_is_not_one_file) {
  const TemporaryFolder folder;
  write(folder.path() / "mine.json", "{}");
  fs::create_symlink("mine.json", folder.path() / "link.svg");
  RunOptions inside;
  inside.folder = folder.path();
  const Words friction{"friction", "--robot", "roboteam_twente_v2024", kFrictionLog.string()};
  struct Two {
    Words words;
    const char* message;
  };
  for (const auto& [words, message] :
       {Two{friction + Words{"--json", "new.toml", "--out", "new.toml"}, "--out and --json name one file"},
        Two{kSimulate + Words{"--out", "new.csv", "--json", "./new.csv"}, "--out and --json name one file"},
        Two{kSimulate + Words{"--out=new.csv", "--json=new.csv"}, "--out and --json name one file"},
        Two{kEvaluate + Words{"--plot", "link.svg", "--json", "mine.json"}, "--plot and --json name one file"},
        Two{{"calibrate", "--motor", "x", "no.csv", "--out", "a", "--json", "a"}, "--out and --json"},
        Two{{"diagnose", "--model", "x", "--train", "no.csv", "--out", "a", "--json", "a"}, "--out and --json"}}) {
    const ProgramRun result = run(words, inside);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(words);
    EXPECT_THAT(result.err, HasSubstr(message)) << testing::PrintToString(words);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(folder.names(), UnorderedElementsAre("link.svg", "mine.json"));
    EXPECT_EQ(content_of(folder.path() / "mine.json"), "{}");
  }
  EXPECT_EQ(run(friction + Words{"--out", "/dev/null", "--json", "/dev/null"}, inside).exit_code, 0);
}

// Environment of the process.

TEST(Surroundings, no_display_no_home_no_colours) {
  const TemporaryFolder folder;
  RunOptions bare;
  bare.folder = folder.path();
  bare.environment = {"DISPLAY", "WAYLAND_DISPLAY", "HOME", "TERM", "LANG", "NO_COLOR=1", "LC_ALL=C"};
  const ProgramRun result = run(kEvaluate + Words{"--samples", "5", "--plot", "verdict.svg"}, bare);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.err, "");  // no progress bar without a terminal
  EXPECT_THAT(result.out, Not(HasSubstr("\x1b[")));
  EXPECT_THAT(content_of(folder.path() / "verdict.svg"), HasSubstr("<svg"));
  EXPECT_THAT(folder.names(), UnorderedElementsAre("verdict.svg"));
  RunOptions coloured;
  coloured.environment = {"TERM=xterm-256color"};
  EXPECT_THAT(run(kEvaluate + Words{"--samples", "5"}, coloured).out, Not(HasSubstr("\x1b[")));
}

TEST(Surroundings, a_locale_with_a_decimal_comma_changes_nothing) {
  RunOptions german;
  german.environment = {"LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"};
  EXPECT_EQ(run(kSteady + Words{"--json", "-"}, german).out, run(kSteady + Words{"--json", "-"}).out);
}

TEST(Surroundings, any_working_directory) {
  RunOptions at_root;
  at_root.folder = "/";
  EXPECT_EQ(run(kSteady, at_root).out, run(kSteady).out);
}

std::vector<std::string> ids(const json& list) {
  std::vector<std::string> result;
  for (const json& item : list.at("items")) {
    result.push_back(item.at("id"));
  }
  return result;
}

TEST(Database, may_be_a_copied_tree) {
  const TemporaryFolder folder;
  const std::string motor = "maxon_ec45_flat_70w_24v.toml";
  fs::create_directories(folder.path() / "motor_db");
  fs::create_directories(folder.path() / "duty_profiles");
  fs::copy_file(kSource / "motor_db" / motor, folder.path() / "motor_db" / "mine.toml");
  fs::copy_file(kSource / "duty_profiles" / "paper_intermittent.toml", folder.path() / "duty_profiles" / "my_duty.toml");
  const Words database{"--db", folder.path().string()};
  EXPECT_THAT(ids(run(Words{"list", "motors", "--json", "-"} + database).json()), UnorderedElementsAre("mine"));
  EXPECT_THAT(ids(run(Words{"list", "duties", "--json", "-"} + database).json()), UnorderedElementsAre("my_duty"));
  EXPECT_THAT(ids(run(Words{"list", "robots", "--json", "-"} + database).json()),
              Contains("tigers_v2020"));  // folders that are missing in the copy use the shipped data
  const ProgramRun result =
      run(Words{"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "my_duty", "--samples", "0", "--json", "-"} + database);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.json().at("motors").at(0).at("id"), "mine");
}

TEST(Database, may_be_a_folder_of_motor_files_alone) {
  const TemporaryFolder folder;
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "mine.toml");
  const Words database{"--db", folder.path().string()};
  EXPECT_THAT(ids(run(Words{"list", "motors", "--json", "-"} + database).json()), UnorderedElementsAre("mine"));
  EXPECT_EQ(
      run(Words{"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "0"} + database).exit_code, 0);
  EXPECT_EQ(run(Words{"steady", "--motor", "mine", "--current-on", "6A", "--time-on", "4s", "--time-off", "6s"} + database).exit_code, 0);
}

TEST(Database, without_any_motor_passes_no_verdict) {
  const TemporaryFolder folder;
  const ProgramRun result =
      run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--db", folder.path().string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("there is no motor file"));
}

TEST(Database, a_motor_may_be_a_path) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "mine with blanks, ä.toml");
  const Words rest{"--current-on", "6A", "--time-on", "4s", "--time-off", "6s", "--json", "-"};
  for (const std::string& path : {std::string("mine with blanks, ä.toml"), std::string("./mine with blanks, ä.toml"),
                                  (folder.path() / "mine with blanks, ä.toml").string()}) {
    const ProgramRun result = run(Words{"steady", "--motor", path} + rest, inside);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.json().at("motor"), "mine with blanks, ä");
  }
}

TEST(Database, a_comma_may_be_part_of_a_path) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "small, fast.toml");
  const ProgramRun result = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                                 "small, fast.toml", "--samples", "0", "--json", "-"},
                                inside);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.json().at("motors").at(0).at("id"), "small, fast");
}

TEST(Database, two_motors_of_one_id_are_ambiguous) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    fs::create_directory(folder.path() / name);
    fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / name / "x.toml");
  }
  const ProgramRun result = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                                 (folder.path() / "b/x.toml").string() + "," + (folder.path() / "a/x.toml").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("two motors with the same id, 'x'"));
}

TEST(Database, a_broken_file_is_reported_and_not_skipped) {
  const TemporaryFolder folder;
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "good.toml");
  write(folder.path() / "broken.toml", "x =");
  for (const Words& words : {Words{"list", "motors"}, Words{"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent"}}) {
    const ProgramRun result = run(words + Words{"--db", folder.path().string()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("broken.toml:1:"));
  }
}

}  // namespace
}  // namespace heatsoak
