// One faulty file is one test: tests/data/bad_<kind>s/bad_<kind>_*.toml. Its first lines state the expected messages,
//   # expect: 7:23: error: figures.torque_constant.value: 'N m' is no unit of this quantity
//   # expect: bad_csv_short_row.csv:3:1: error: has 2 cells
// with the place and the beginning of each message. Files that cannot hold a comment have these lines in <file>.expect.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "base/diagnostic.h"
#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

const fs::path kData = kSource / "tests" / "data";

/// Returns the data folder for the file's kind.
fs::path folder_of(const std::string& file) {
  return kData / (file.starts_with("bad_motor_") ? "bad_motors" : file.starts_with("bad_robot_") ? "bad_robots" : "bad_duties");
}
fs::path path_of(const std::string& file) { return folder_of(file) / file; }

/// Returns the expected beginnings of complete lines of stderr.
std::vector<std::string> expectations(const std::string& file) {
  const fs::path aside = path_of(file + ".expect");
  std::istringstream lines(content_of(fs::exists(aside) ? aside : path_of(file)));
  std::vector<std::string> result;
  const std::string mark = "# expect: ";
  for (std::string line; std::getline(lines, line) && line.starts_with(mark);) {
    const std::string rest = line.substr(mark.size());
    const bool names_a_file = rest.starts_with("bad_");
    result.push_back(names_a_file ? path_of(rest).string() : path_of(file).string() + (rest.starts_with("error") ? ": " : ":") + rest);
  }
  // Paths inside a message are relative to the data folder.
  for (std::string& line : result) {
    if (const std::size_t at = line.find(": ./"); at != std::string::npos) {
      line.replace(at + 2, 1, folder_of(file).string());
    }
  }
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Formats a diagnostic like a line of stderr.
std::string line_of(const json& diagnostic) {
  // In JSON, 0 stands for the file as a whole.
  const auto number = [&](const char* key) {
    const int value = diagnostic.at(key);
    return value > 0 ? std::optional(value) : std::nullopt;
  };
  return base::to_string(
      base::Diagnostic{{diagnostic.at("file"), number("line"), number("column")}, diagnostic.at("key"), diagnostic.at("message")});
}

std::vector<std::string> lines_of(const json& error) {
  std::vector<std::string> lines;
  for (const json& each : error.at("error").at("diagnostics")) {
    lines.push_back(line_of(each));
  }
  return lines;
}

void expect_error_object(const json& answer) {
  ASSERT_TRUE(answer.contains("error")) << answer.dump(2);
  EXPECT_EQ(answer["error"].at("code"), 2);
  EXPECT_TRUE(answer["error"].at("message").is_string());
  EXPECT_THAT(answer["error"].at("message").get<std::string>(), Not(IsEmpty()));
}

void expect_lines(const std::vector<std::string>& expected, const std::vector<std::string>& said) {
  ASSERT_EQ(said.size(), expected.size()) << testing::PrintToString(said);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(said[i].starts_with(expected[i])) << "said:     " << said[i] << "\nexpected: " << expected[i];
  }
}

/// Returns arguments that combine the faulty file with valid ones.
std::vector<std::string> roles(const std::string& verb, const std::string& file) {
  std::string motor = "maxon_ec45_flat_70w_24v";
  std::string robot = "roboteam_twente_v2024";
  std::string duty = "paper_intermittent";
  (file.starts_with("bad_motor") ? motor : file.starts_with("bad_robot") ? robot : duty) = path_of(file).string();
  return {verb, verb == "evaluate" ? "--motors" : "--motor", motor, "--robot", robot, "--duty", duty};
}

class BadFile : public testing::TestWithParam<std::string> {};

TEST_P(BadFile, is_refused_with_place_and_reason) {
  const ProgramRun result = run(roles("evaluate", GetParam()));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  const std::vector<std::string> expected = expectations(GetParam());
  ASSERT_THAT(expected, Not(IsEmpty())) << GetParam() << " does not say what is expected";
  expect_lines(expected, lines_of(result.err));
}

TEST_P(BadFile, is_refused_by_lint_in_the_same_words) {
  const ProgramRun result = run({"lint", path_of(GetParam()).string(), "--json", "-"});
  EXPECT_EQ(result.exit_code, 2);
  expect_error_object(result.json());
  if (GetParam() != "bad_robot_empty.toml" && GetParam() != "bad_duty_empty.toml") {  // an empty file does not state its kind
    expect_lines(expectations(GetParam()), lines_of(result.err));
  }
}

TEST_P(BadFile, is_reported_as_json) {
  std::vector<std::string> words = roles("evaluate", GetParam());
  words.insert(words.end(), {"--json", "-"});
  const ProgramRun result = run(words);
  EXPECT_EQ(result.exit_code, 2);
  const json answer = result.json();
  expect_error_object(answer);
  expect_lines(expectations(GetParam()), lines_of(answer));
}

TEST_P(BadFile, leaves_no_output) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  std::vector<std::string> words = roles("simulate", GetParam());
  words.insert(words.end(), {"--out", "trace.csv", "--plot", "trace.svg", "--json", "answer.json"});
  const ProgramRun result = run(words, inside);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("answer.json"));
  expect_error_object(json::parse(content_of(folder.path() / "answer.json")));
}

std::vector<std::string> bad_files() {
  std::vector<std::string> all;
  for (const char* kind : {"bad_motor_", "bad_robot_", "bad_duty_"}) {
    const std::vector<std::string> some = files_of(folder_of(kind), kind, ".toml");
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(tests_data, BadFile, testing::ValuesIn(bad_files()),
                         [](const auto& instance) { return test_name(instance.param); });

// Files that are created at run time because they are too large to store or are no regular files.

std::string good_motor() { return content_of(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml"); }

std::string recorded(const std::string& csv) {
  return "summary = \"x\"\norigin = \"x\"\nshape = \"recorded\"\nambient = { value = \"25 degC\", origin = \"estimated\", derivation = "
         "\"x\" }\n"
         "[recorded]\nquantity = \"torque\"\nfile = \"" +
         csv + "\"\n";
}

/// Checks that the program ends quickly, within its memory limit, and reports the reason.
void expect_refused(const ProgramRun& result, const std::string& reason) {
  EXPECT_EQ(result.exit_code, 2) << result.err.substr(0, 1000);
  EXPECT_THAT(result.err.substr(0, 1000), HasSubstr(reason));
  EXPECT_LT(result.err.size(), 20'000U);
  EXPECT_LT(result.memory_MB, 300.0);
}

ProgramRun run_duty(const fs::path& duty) {
  return run(
      {"evaluate", "--robot", "roboteam_twente_v2024", "--duty", duty.string(), "--motors", "maxon_ec45_flat_70w_24v", "--samples", "0"});
}

TEST(HugeFile, toml) {
  const TemporaryFolder folder;
  write(folder.path() / "huge.toml", good_motor() + std::string(100'000'000, '#'));
  expect_refused(run({"lint", (folder.path() / "huge.toml").string()}), "larger than");
}

TEST(HugeFile, csv_of_one_cell) {
  const TemporaryFolder folder;
  write(folder.path() / "huge.csv", std::string(100'000'000, '1'));
  write(folder.path() / "duty.toml", recorded("huge.csv"));
  expect_refused(run_duty(folder.path() / "duty.toml"), "a cell is longer");
}

TEST(HugeFile, csv_of_columns) {
  const TemporaryFolder folder;
  write(folder.path() / "huge.csv", std::string(100'000'000, ','));
  write(folder.path() / "duty.toml", recorded("huge.csv"));
  expect_refused(run_duty(folder.path() / "duty.toml"), "columns");
}

TEST(HugeFile, csv_with_an_open_quote) {
  const TemporaryFolder folder;
  std::string content = "time_s,torque_Nm,speed_rad_per_s\n0,\"1,1\n";
  for (int i = 0; i < 5'000'000; ++i) {
    content += "1,0.1,40\n";
  }
  write(folder.path() / "huge.csv", content);
  write(folder.path() / "duty.toml", recorded("huge.csv"));
  expect_refused(run_duty(folder.path() / "duty.toml"), "quote");
}

TEST(HugeFile, csv_of_too_many_rows) {
  const TemporaryFolder folder;
  std::string content = "time_s,torque_Nm,speed_rad_per_s\n";
  for (int i = 0; content.size() < 100'000'000; ++i) {
    content += std::to_string(i) + ",0.1,40\n";
  }
  write(folder.path() / "huge.csv", content);
  write(folder.path() / "duty.toml", recorded("huge.csv"));
  expect_refused(run_duty(folder.path() / "duty.toml"), "rows");
}

TEST(HugeFile, csv_with_nothing_but_problems) {
  const TemporaryFolder folder;
  std::string content = "time_s,torque_Nm,speed_rad_per_s\n";
  while (content.size() < 100'000'000) {
    content += "a,b,c,d\n";
  }
  write(folder.path() / "huge.csv", content);
  write(folder.path() / "duty.toml", recorded("huge.csv"));
  const ProgramRun result = run_duty(folder.path() / "duty.toml");
  expect_refused(result, "has 4 cells");
  EXPECT_THAT(result.err, HasSubstr("more problems; the rest was not read"));
}

// A Unix time stamp in one row would make a duty of decades.
TEST(Endless, recording_of_decades) {
  const TemporaryFolder folder;
  write(folder.path() / "long.csv", "time_s,torque_Nm,speed_rad_per_s\n0,0.05,40\n1700000000,0,0\n");
  write(folder.path() / "duty.toml", recorded("long.csv"));
  expect_refused(run_duty(folder.path() / "duty.toml"), "expected about the length of a match");
}

TEST(Endless, effect_that_settles_within_microseconds) {
  const TemporaryFolder folder;
  write(folder.path() / "motor.toml", good_motor() +
                                          "\n[effects.flange]\ntype = \"conduction\"\nhot = \"winding\"\ncold = \"stator\"\n"
                                          "thermal_resistance = { value = \"1e-5 K/W\", origin = \"estimated\", derivation = \"x\" }\n");
  expect_refused(run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                      (folder.path() / "motor.toml").string()}),
                 "out of range");
}

TEST(HugeFile, recording_repeated_without_end) {
  const TemporaryFolder folder;
  std::string content = "time_s,torque_Nm,speed_rad_per_s\n";
  for (int i = 0; i < 100'000; ++i) {
    content += std::to_string(i) + ",0.1,40\n";
  }
  write(folder.path() / "long.csv", content);
  write(folder.path() / "duty.toml", recorded("long.csv") + "repeats = \"10000\"\n");
  expect_refused(run_duty(folder.path() / "duty.toml"), "recorded.repeats");
}

/// An object in place of a regular file.
struct Oddity {
  std::string name;
  std::string reason;
};
class NoFile : public testing::TestWithParam<Oddity> {};

TEST_P(NoFile, is_refused_at_once) {
  const TemporaryFolder folder;
  const fs::path file = GetParam().name == "device"    ? fs::path("/dev/zero")
                        : GetParam().name == "missing" ? folder.path() / "missing.toml"
                                                       : folder.path() / "odd.toml";
  if (GetParam().name == "folder") {
    fs::create_directory(file);
  } else if (GetParam().name == "pipe") {
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  } else if (GetParam().name == "link_to_itself") {
    fs::create_symlink(file, file);
  } else if (GetParam().name == "link_to_nothing") {
    fs::create_symlink(folder.path() / "nothing", file);
  }
  expect_refused(run({"lint", file.string()}), GetParam().reason);
  expect_refused(run({"steady", "--motor", file.string(), "--current-on", "1", "--time-on", "1", "--time-off", "1"}), GetParam().reason);
  expect_refused(run({"evaluate", "--robot", file.string(), "--duty", "paper_intermittent"}), GetParam().reason);
  write(folder.path() / "duty.toml", recorded(file.string()));
  expect_refused(run_duty(folder.path() / "duty.toml"), GetParam().reason);
}

INSTANTIATE_TEST_SUITE_P(odd, NoFile,
                         testing::Values(Oddity{"device", "device"}, Oddity{"folder", "folder"}, Oddity{"pipe", "pipe"},
                                         Oddity{"missing", "No such file"}, Oddity{"link_to_itself", "symbolic links"},
                                         Oddity{"link_to_nothing", "No such file"}),
                         [](const auto& instance) { return instance.param.name; });

TEST(NoPermission, is_reported) {
  const TemporaryFolder folder;
  write(folder.path() / "secret.toml", good_motor());
  fs::permissions(folder.path() / "secret.toml", fs::perms::none);
  fs::permissions(folder.path(), fs::perms::all);
  write(folder.path() / "open.toml", good_motor());
  // root may read every file, so the test runs as another user. It is skipped if that user cannot reach the program.
  const std::string lint = fmt::format(
      "{}heatsoak lint '{}/", ::geteuid() != 0 ? "" : "setpriv --reuid 65534 --regid 65534 --clear-groups ", folder.path().string());
  const ProgramRun readable = run_line(lint + "open.toml'");
  if (::geteuid() == 0 && readable.exit_code != 0) {
    GTEST_SKIP() << readable.err;
  }
  const ProgramRun result = run_line(lint + "secret.toml'");
  expect_refused(result, "Permission denied");
}

// Valid files with unusual contents.

TEST(OddButGood, carriage_returns_and_byte_order_mark) {
  const TemporaryFolder folder;
  const auto oddly = [](const std::string& text) {
    std::string odd = "\xEF\xBB\xBF";
    for (const char c : text) {
      odd += c == '\n' ? "\r\n" : std::string(1, c);
    }
    return odd;
  };
  write(folder.path() / "motor.toml", oddly(good_motor()));
  write(folder.path() / "duty.csv", oddly("time_s,torque_Nm,speed_rad_per_s\n0,0.05,40\n10,0.02,40\n20,0,0\n"));
  write(folder.path() / "duty.toml", oddly(recorded("duty.csv")));
  RunOptions inside;
  inside.folder = folder.path();
  const ProgramRun result =
      run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "duty.toml", "--motors", "motor.toml", "--samples", "0"}, inside);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(run({"lint", "motor.toml", "duty.toml"}, inside).exit_code, 0);
}

TEST(OddButGood, long_texts_and_dots_in_texts_and_comments) {
  const TemporaryFolder folder;
  const std::string dots(5000, '.');
  write(folder.path() / "robot.toml",
        "# a" + dots + "\nname = \"" + dots + "\"\nsource = \"\"\"a\n" + dots + "\\\"\n\"\"\"\nnotes = ['" + dots + "', \"\\\"" + dots +
            "\"]  # " + dots + "\n" +
            "mass = \"2.6 kg\"\n[wheels]\nradius = \"28 mm\"\ncontact_radius = \"80 mm\"\n"
            "axis_angles = [\"-30 deg\", \"30 deg\", \"180 deg\"]\n[drive]\nmotor = \"x\"\ngear_ratio = \"1\"\ncommutation = \"block\"\n"
            "[battery]\nnominal_voltage = \"22 V\"\n");
  EXPECT_EQ(run({"lint", (folder.path() / "robot.toml").string()}).err, "");
}

}  // namespace
}  // namespace heatsoak
