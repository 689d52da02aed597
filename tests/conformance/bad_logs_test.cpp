// Faulty recordings of drives and runs: messages and exit codes.
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "../friction/test_drive.h"
#include "../recording/synthetic_log.h"
#include "base/files.h"
#include "motor/motor.h"
#include "program_run.h"
#include "robot/robot.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
const std::vector<friction::DriveRow>& driven_rows() {
  static const std::vector<friction::DriveRow> rows = [] {
    friction::TestDrive drive;
    for (int i = 0; i < 12; ++i) {
      drive.headings_rad.push_back(0.1 + i * std::numbers::pi / 6.0);
    }
    drive.speeds_m_per_s = {0.5, 1.0};
    const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
    const motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
    return friction::DriveOnPlant(robot::make_plant(robot, motor.nominal, 0.001), drive, 3).rows();
  }();
  return rows;
}

struct BadDrive {
  std::string name;
  std::function<void(std::vector<friction::DriveRow>&)> spoil;
  int friction_exit = 0;
  std::string friction_says;
  int inspect_exit = 0;
  std::string inspect_says = {};
};

void PrintTo(const BadDrive& drive, std::ostream* out) { *out << drive.name; }

template <class Change>
std::function<void(std::vector<friction::DriveRow>&)> of_each(Change change) {
  return [change](std::vector<friction::DriveRow>& rows) { std::ranges::for_each(rows, change); };
}

class BadDrives : public testing::TestWithParam<BadDrive> {};

TEST_P(BadDrives, are_reported) {
  const BadDrive& bad = GetParam();
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "drive.csv";
  std::vector<friction::DriveRow> rows = driven_rows();
  bad.spoil(rows);
  write(log, friction::csv_of(rows, 4));
  const ProgramRun friction = run({"friction", "--robot", "roboteam_twente_v2024", log.string()});
  EXPECT_EQ(friction.exit_code, bad.friction_exit) << friction.err;
  EXPECT_THAT(friction.out + friction.err, testing::HasSubstr(bad.friction_says));
  if (bad.friction_exit == 2 && bad.inspect_exit == 0) {
    EXPECT_EQ(run({"friction", "--robot", "roboteam_twente_v2024", log.string(), "--as-is"}).exit_code, 0);
  }
  const ProgramRun inspect = run({"log", "inspect", log.string()});
  EXPECT_EQ(inspect.exit_code, bad.inspect_exit) << inspect.err;
  EXPECT_THAT(inspect.out + inspect.err, testing::HasSubstr(bad.inspect_says));
}

INSTANTIATE_TEST_SUITE_P(
    One, BadDrives,
    testing::Values(
        BadDrive{"percent",
                 of_each([](friction::DriveRow& row) { std::ranges::for_each(row.pwm_ratio, [](double& each) { each *= 100.0; }); }), 2,
                 "wheel_modulation_ratio_1 reaches", 0, "is it in percent"},
        BadDrive{"millivolts", of_each([](friction::DriveRow& row) { row.battery_V *= 1000.0; }), 2, "is it in millivolts?", 0,
                 "is it in millivolts?"},
        BadDrive{"degrees", of_each([](friction::DriveRow& row) {
                   row.command_heading_rad *= 180.0 / std::numbers::pi;
                   row.yaw_rad *= 180.0 / std::numbers::pi;
                 }),
                 2, "off the direction that follows from the wheels' speeds", 0, "heading_field_rad spans"},
        BadDrive{"revolutions_per_minute", of_each([](friction::DriveRow& row) {
                   std::ranges::for_each(row.wheel_speed_rad_per_s, [](double& each) { each *= 30.0 / std::numbers::pi; });
                 }),
                 2, "times the motor's back-EMF"},
        BadDrive{"other_sign",
                 of_each([](friction::DriveRow& row) { std::ranges::for_each(row.pwm_ratio, [](double& each) { each = -each; }); }), 2,
                 "have the wrong sign?"},
        BadDrive{"other_sign_of_one_wheel", of_each([](friction::DriveRow& row) { row.pwm_ratio[1] = -row.pwm_ratio[1]; }), 2,
                 "voltage of wheel 2 falls as it turns faster"},
        BadDrive{"dead_modulation", of_each([](friction::DriveRow& row) { row.pwm_ratio[0] = 0.0; }), 2,
                 "wheel 1 turns with hardly any voltage"},
        BadDrive{"modulations_swapped", of_each([](friction::DriveRow& row) { std::swap(row.pwm_ratio[0], row.pwm_ratio[1]); }), 2,
                 "of wheel 1"},
        BadDrive{"battery_doubled", of_each([](friction::DriveRow& row) { row.battery_V *= 2.0; }), 2, "times the back-EMF of the motor"},
        BadDrive{"other_order", of_each([](friction::DriveRow& row) {
                   std::swap(row.wheel_speed_rad_per_s[0], row.wheel_speed_rad_per_s[1]);
                   std::swap(row.pwm_ratio[0], row.pwm_ratio[1]);
                 }),
                 2, "do their order or signs differ from the robot's file"},
        BadDrive{"milliseconds", of_each([](friction::DriveRow& row) { row.time_s *= 1e3; }), 2, "is the time in milliseconds?", 0,
                 "is the time in milliseconds?"},
        BadDrive{"microseconds", of_each([](friction::DriveRow& row) { row.time_s *= 1e6; }), 2, "days at 10000 s per row", 0,
                 "days at 10000 s per row"},
        BadDrive{"unsorted", [](std::vector<friction::DriveRow>& rows) { std::ranges::reverse(rows); }, 2, "time does not increase", 2,
                 "time does not increase"},
        BadDrive{"too_short", [](std::vector<friction::DriveRow>& rows) { rows.resize(8); }, 3,
                 "in no interval do the wheels turn steadily", 3, "it has 8 rows; at least 20 are needed"},
        BadDrive{"no_number", of_each([](friction::DriveRow& row) {
                   row.battery_V = row.command_heading_rad = row.yaw_rad = std::nan("");
                   row.wheel_speed_rad_per_s.fill(std::nan(""));
                   row.pwm_ratio.fill(std::nan(""));
                 }),
                 3, "no quantity except the time contains a number", 3, "no quantity except the time contains a number"},
        BadDrive{"standing", of_each([](friction::DriveRow& row) {
                   row.wheel_speed_rad_per_s.fill(0.0);
                   row.pwm_ratio.fill(0.0);
                 }),
                 3, "in no interval do the wheels turn steadily", 3, "no wheel changes its speed beyond the noise"},
        BadDrive{"one_heading", [](std::vector<friction::DriveRow>& rows) { rows.resize(rows.size() / 24); }, 3, "nothing is identifiable",
                 0, ": usable for wheel models."}),
    [](const auto& each) { return each.param.name; });

/// Rows of a run, cell by cell: time, winding, stator, ambient, current.
using Cells = std::vector<double>;
struct BadRun {
  std::string name;
  std::function<void(std::vector<Cells>&)> spoil;
  int exit_code = 0;
  std::string says;
};

void PrintTo(const BadRun& each, std::ostream* out) { *out << each.name; }

std::string run_text(const std::function<void(std::vector<Cells>&)>& spoil) {
  const recording::SyntheticLog log;
  std::vector<Cells> rows;
  for (const auto& [winding_C, stator_C] : log.temperatures_C()) {
    const double time_s = static_cast<double>(rows.size()) * log.period_s;
    rows.push_back({time_s, winding_C, stator_C, 22.0, log.current_A(time_s)});
  }
  spoil(rows);
  std::string text = "time_s,winding_C,stator_C,ambient_C,current_A\n";
  for (const Cells& row : rows) {
    text += fmt::format("{:.4f}\n", fmt::join(row, ","));
  }
  return text;
}

class BadRuns : public testing::TestWithParam<BadRun> {};

TEST_P(BadRuns, are_reported_by_log_inspect) {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "run.csv";
  write(log, run_text(GetParam().spoil));
  const ProgramRun result = run({"log", "inspect", log.string()});
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_THAT(result.out + result.err, testing::HasSubstr(GetParam().says));
}

std::function<void(std::vector<Cells>&)> cells(std::function<void(Cells&)> change) {
  return [change](std::vector<Cells>& rows) { std::ranges::for_each(rows, change); };
}

INSTANTIATE_TEST_SUITE_P(
    One, BadRuns,
    testing::Values(BadRun{"sound", [](std::vector<Cells>&) {}, 0, ": usable for thermal models."},
                    BadRun{"fahrenheit", cells([](Cells& row) { row[1] = 32.0 + 1.8 * row[1]; }), 0, "is it in degrees Fahrenheit"},
                    BadRun{"fahrenheit_of_a_motor_that_heats_at_once",
                           [](std::vector<Cells>& rows) {
                             rows.erase(rows.begin());
                             std::ranges::for_each(rows, [](Cells& row) { row[1] = 32.0 + 1.8 * row[1]; });
                           },
                           0, "is it in degrees Fahrenheit"},
                    BadRun{"milliamperes", cells([](Cells& row) { row[4] *= 1000.0; }), 0, "is it in milliamperes?"},
                    BadRun{"minutes", cells([](Cells& row) { row[0] /= 60.0; }), 0, "is the time in minutes?"},
                    BadRun{"wild_current", [](std::vector<Cells>& rows) { rows[70][4] = 1e308; }, 0,
                           "left out: 1 sample of current_A: outside the possible range; line 72 (\"1e+308\")"},
                    BadRun{"swapped", cells([](Cells& row) { std::swap(row[1], row[2]); }), 0, "are the two swapped?"},
                    BadRun{"constant", cells([](Cells& row) {
                             row = {row[0], 22.0, 22.0, 22.0, 0.0};
                           }),
                           3, "winding_C is constant, 22 °C"},
                    BadRun{"too_short", [](std::vector<Cells>& rows) { rows.resize(12); }, 3, "it has 12 rows; at least 20 are needed"},
                    BadRun{"unexcited", cells([](Cells& row) { row[4] = 0.0; }), 3, "there is no heat input: current_A is 0 throughout"},
                    BadRun{"no_number", cells([](Cells& row) {
                             row = {row[0], std::nan(""), std::nan(""), std::nan(""), std::nan("")};
                           }),
                           3, "no quantity except the time contains a number"},
                    BadRun{"unsorted", [](std::vector<Cells>& rows) { std::ranges::reverse(rows); }, 2, "time does not increase"}),
    [](const auto& each) { return each.param.name; });

TEST(BadLogs, of_friction_with_exchanged_columns_are_not_the_same_log) {
  const TemporaryFolder folder;
  const std::string text = friction::csv_of(driven_rows(), 4);
  std::string exchanged = text;
  const std::size_t first = exchanged.find("wheel_speed_rad_per_s_1");
  exchanged.replace(first, 23, "wheel_speed_rad_per_s_2");
  exchanged.replace(exchanged.find("wheel_speed_rad_per_s_2", first + 1), 23, "wheel_speed_rad_per_s_1");
  write(folder.path() / "one.csv", text);
  write(folder.path() / "copy.csv", text);
  write(folder.path() / "exchanged.csv", exchanged);
  const Words friction{"friction", "--robot", "roboteam_twente_v2024", "--as-is"};
  const ProgramRun apart = run(friction + Words{"one.csv", "exchanged.csv"}, {.folder = folder.path()});
  EXPECT_THAT(apart.err, testing::Not(testing::HasSubstr("share rows"))) << apart.err;
  const ProgramRun same = run(friction + Words{"one.csv", "exchanged.csv", "copy.csv"}, {.folder = folder.path()});
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_THAT(same.err, testing::HasSubstr("copy.csv:2:1: error: lines 2 to "));
}

/// Every place that the terminal shows must be in the JSON answer too.
void expect_places_in_json(const Words& words, const fs::path& folder, std::size_t least) {
  const ProgramRun result = run(words + Words{"--json", "error.json"}, {.folder = folder});
  std::ifstream file(folder / "error.json");
  const nlohmann::json error = nlohmann::json::parse(file).at("error");
  static const std::regex kPlace("(^|\n)([^\n: ]+):(\\d+):(\\d+): error: ");
  std::size_t places = 0;
  for (std::sregex_iterator found(result.err.begin(), result.err.end(), kPlace), end; found != end; ++found, ++places) {
    const bool is_listed = std::ranges::any_of(error.at("diagnostics"), [&found](const nlohmann::json& each) {
      return each.at("file") == (*found)[2].str() && each.at("line") == std::stoi((*found)[3].str()) &&
             each.at("column") == std::stoi((*found)[4].str());
    });
    EXPECT_TRUE(is_listed) << found->str() << error.dump(2);
  }
  EXPECT_GE(places, least) << result.err;
  EXPECT_EQ(error.at("code"), result.exit_code);
}

TEST(BadLogs, have_their_places_in_json_and_all_kinds_in_one_run) {
  const TemporaryFolder folder;
  const std::string bench = base::read_file(kSource / "reports/soak/bench.csv", 10'000'000);
  write(folder.path() / "bench.csv", bench);
  write(folder.path() / "no_time.csv", "t,winding_C\n0,25\n1,26\n");
  write(folder.path() / "no_number.csv", "time_s,winding_C\n0,\n1,\n");
  std::istringstream lines(bench);
  std::string outliers;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    // Too many rows for a spike, less than 2 % of the log.
    if (number > 900 && number <= 925) {
      const std::size_t cell = line.rfind(',', line.rfind(',') - 1) + 1;
      line.replace(cell, line.rfind(',') - cell, std::to_string(4 * number - 3200));
    }
    outliers += line + "\n";
  }
  write(folder.path() / "outliers.csv", outliers);
  const Words logs{"bench.csv", "no_time.csv", "no_number.csv", "outliers.csv", "missing.csv"};
  const std::string motor = "maxon_ec45_flat_70w_24v";
  for (const Words& verb : {Words{"calibrate", "--motor", motor, "--out", "model.toml"}, Words{"predict", "--model", motor},
                            Words{"diagnose", "--model", motor, "--train"}}) {
    expect_places_in_json(verb + logs, folder.path(), 3);
    const ProgramRun result = run(verb + logs, {.folder = folder.path()});
    EXPECT_THAT(result.err, testing::AllOf(testing::HasSubstr("missing.csv: error: "),
                                           testing::HasSubstr("outliers.csv:925:1: error: current_A reaches 500 A")));
  }
  write(folder.path() / "broken.toml", "name = 3\n[wheels\n");
  for (const Words& words :
       {Words{"lint", "broken.toml"},
        Words{"steady", "--motor", "broken.toml", "--current-on", "1A", "--time-on", "1s", "--time-off", "1s"},
        Words{"evaluate", "--robot", "broken.toml", "--duty", "division_a_match"}, Words{"friction", "--robot", "broken.toml", "bench.csv"},
        Words{"predict", "--model", motor, "--map", "broken.toml", "bench.csv"}, Words{"check", "broken.toml"}}) {
    expect_places_in_json(words, folder.path(), 1);
  }
}

}  // namespace
}  // namespace heatsoak
