// Every file of the data folders: list, describe, lint and evaluate; and the lines that `describe` gives to paste.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

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
    [](const auto& instance) { return "value_" + std::to_string(instance.index); });

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
  const bool is_doubled =
      GetParam() == "copper_loss" || GetParam() == "no_load_loss" || GetParam() == "input_power_loss" || GetParam() == "uneven_winding";
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

}  // namespace
}  // namespace heatsoak
