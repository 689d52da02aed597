// Checks with a command: every number in the JSON answer of a command can have a limit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>

#include "check/answer_number.h"
#include "program_run.h"
#include "recording/quantities.h"
#include "soak_example.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

/// The commands of the interface with small inputs.
std::vector<std::string> commands() {
  const std::string friction_log = (kSource / "reports/friction_test/steady_state_test.csv").string();
  return {"evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors maxon_ecx_flat_42m_24v --samples 80",
          "simulate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --duty division_a_match --guard on",
          "derate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --samples 60",
          fmt::format("predict --model {} '{}'", kMotor, log("match_1.csv")),
          fmt::format("calibrate --motor {} '{}' '{}' --seed 5 --out model.toml", kMotor, log("bench.csv"), log("match_1.csv")),
          fmt::format("diagnose --model {} --train '{}' --holdout '{}' --out diagnosis", kMotor, log("bench.csv"), log("match_3.csv")),
          fmt::format("friction --robot roboteam_twente_v2024 '{}' --out robot.toml", friction_log)};
}

struct NamedNumber {
  std::string name;
  double value = 0.0;
};

/// Returns all numbers with their names by the rules of `describe command`.
void collect(const ordered_json& value, const std::string& name, std::vector<NamedNumber>& all) {
  const std::string before = name.empty() ? "" : name + ".";
  if (value.is_number()) {
    all.push_back({name, value.get<double>()});
  } else if (value.is_object()) {
    for (const auto& [key, each] : value.items()) {
      if (key != "ranges") {
        collect(each, before + key, all);
      }
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const bool has_key = value[i].is_object() && !value[i].empty();
      const ordered_json first = has_key ? value[i].begin().value() : ordered_json();
      collect(value[i],
              before + (first.is_string()           ? first.get<std::string>()
                        : first.is_number_integer() ? first.dump()
                                                    : std::to_string(i)),
              all);
    }
  }
}

/// Returns whether a limit has the unit of a signal that encloses its number: of "error.winding_C.samples" it must not be a temperature.
bool has_unit_of_a_signal(const std::string& name, const std::string& limit) {
  const std::size_t last = name.rfind('.');
  for (std::size_t begin = 0; last != std::string::npos && begin < last;) {
    const std::size_t end = name.find('.', begin);
    const std::optional<recording::Quantity> signal = recording::quantity_named(name.substr(begin, end - begin));
    const bool is_list = std::isdigit(static_cast<unsigned char>(name[end + 1])) != 0;
    // A quantity without meaning is not in the table of the signals.
    if (signal && !signal->meaning.empty() && !signal->unit.empty() && !is_list && limit.ends_with(" " + signal->unit)) {
      return true;
    }
    begin = end + 1;
  }
  return false;
}

class EveryNumber : public testing::TestWithParam<std::size_t> {
 protected:
  EveryNumber() {
    options_.folder = folder_.path();
    options_.environment = {"GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "GITHUB_WORKSPACE"};
  }
  /// Returns the thresholds of a check of the command with these limits, one for each number.
  [[nodiscard]] ordered_json thresholds(const std::string& command, const std::vector<NamedNumber>& numbers,
                                        const std::vector<std::string>& limits) const {
    std::string text = fmt::format("[[check]]\nname = \"x\"\ncommand = \"\"\"{}\"\"\"\n[check.limits]\n", command);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      text += fmt::format("{} = \"{}\"\n", ordered_json(numbers[i].name).dump(), limits[i]);
    }
    write(folder_.path() / "all.check.toml", text);
    const ProgramRun done = run({"check", "all.check.toml", "--json", "-"}, options_);
    EXPECT_LE(done.exit_code, 1) << done.err;
    return ordered_json::parse(done.out).at("thresholds");
  }

  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_P(EveryNumber, CanHaveALimit) {
  const std::string command = commands().at(GetParam());
  const ProgramRun done = run_line("heatsoak " + command + " --json -", in(TemporaryFolder()));
  std::vector<NamedNumber> found;
  collect(ordered_json::parse(done.out), "", found);
  // Elements of a list may share their first key; then the worst of them counts.
  std::map<std::string, double> most;
  for (const NamedNumber& each : found) {
    const auto [place, is_new] = most.emplace(each.name, each.value);
    place->second = is_new ? each.value : std::max(place->second, each.value);
  }
  std::vector<NamedNumber> numbers;
  std::vector<std::string> limits;
  for (const auto& [name, value] : most) {
    numbers.push_back({name, value});
    limits.emplace_back("at most 1e30");
  }
  ASSERT_GT(numbers.size(), 5U);
  // The message about a missing unit names the unit.
  const ordered_json without_units = thresholds(command, numbers, limits);
  const std::regex unit("has no unit; expected a number with a unit such as \"1.5 ([^\"]+)\"");
  std::size_t with_unit = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string reason = without_units[i].at("reason");
    std::smatch named;
    const bool has_unit = std::regex_search(reason, named, unit);
    EXPECT_TRUE(has_unit || without_units[i].at("passed").get<bool>()) << numbers[i].name << ": " << reason;
    with_unit += has_unit ? 1 : 0;
    const double room = 1e-6 * std::abs(numbers[i].value) + 1e-12;
    limits[i] = fmt::format("at most {:.12g}{}", numbers[i].value + room, has_unit ? " " + named[1].str() : "");
  }
  EXPECT_GT(with_unit, 0U);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_FALSE(has_unit_of_a_signal(numbers[i].name, limits[i])) << numbers[i].name << " " << limits[i];
  }
  const ordered_json exact = thresholds(command, numbers, limits);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool has_interval = exact[i].at("detail").get<std::string>().find("95 % interval") != std::string::npos;
    EXPECT_TRUE(exact[i].at("evaluated").get<bool>()) << numbers[i].name << ": " << exact[i].at("reason");
    EXPECT_TRUE(has_interval || exact[i].at("passed").get<bool>()) << numbers[i].name << " " << limits[i] << ": " << exact[i].at("reason");
  }
  EXPECT_THAT(folder_.names(), ElementsAre("all.check.toml")) << "a command of a check writes no file";
}

/// Returns whether a number of this name and unit can never be negative.
bool is_size(const check::AnswerNumber& number) {
  const auto has = [&number](std::string_view part) { return number.name.find(part) != std::string::npos; };
  const bool is_share = number.unit.empty() && (has("probability") || has("share") || has("coverage"));
  return is_share || number.unit == "s" || has("rms") || has("max_abs") || has("distance");
}

// Without a declared range, --update may write a limit that cannot fail.
TEST_P(EveryNumber, LiesInTheRangeThatItsAnswerDeclares) {
  const ProgramRun done = run_line("heatsoak " + commands().at(GetParam()) + " --json -", in(TemporaryFolder()));
  const ordered_json answer = ordered_json::parse(done.out);
  std::vector<NamedNumber> found;
  collect(answer, "", found);
  for (const NamedNumber& each : found) {
    for (const check::AnswerNumber& number : check::numbers_at(answer, each.name)) {
      EXPECT_TRUE(number.possible.contains(number.value)) << number.name << " " << number.value;
      EXPECT_TRUE(!is_size(number) || number.possible.low >= 0.0) << number.name << " has no declared range";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, EveryNumber, testing::Range(std::size_t{0}, std::size_t{7}),
                         [](const auto& each) { return commands().at(each.param).substr(0, commands().at(each.param).find(' ')); });

class CommandOfACheck : public EveryNumber {
 protected:
  [[nodiscard]] ProgramRun checked(const std::string& command, const std::string& limits, const Words& more = {}) const {
    write(folder_.path() / "a.check.toml", fmt::format("[[check]]\nname = \"x\"\ncommand = '{}'\n[check.limits]\n{}", command, limits));
    return run(Words{"check", "a.check.toml"} + more, options_);
  }
};

TEST_F(CommandOfACheck, ThatIsWrongIsAMistakeInTheFile) {
  const std::string limit = "heat_reserve_ratio = \"at most 2\"\n";
  for (const auto& [command, reason] : std::vector<std::pair<std::string, std::string>>{
           {"derate --motor no_such_motor --robot roboteam_twente_v2024", "there is no motor"},
           {"derate --moter x", "did you mean '--motor'"},
           {"derive", "there is no verb 'derive'; did you mean 'derate'?"},
           {"derate --help", "has no JSON answer"},
           {"completion bash", "has no JSON answer"},
           {"derate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --samples 60 --json x.json", "without --json"}}) {
    const ProgramRun done = checked(command, limit);
    EXPECT_EQ(done.exit_code, 2) << command << done.err;
    EXPECT_THAT(done.err, HasSubstr("a.check.toml:3:11: error: check[0].command: ")) << command;
    EXPECT_THAT(done.err, HasSubstr(reason)) << command;
    EXPECT_THAT(folder_.names(), ElementsAre("a.check.toml")) << command;
  }
}

// The second check would compute for minutes.
TEST_F(CommandOfACheck, ThatIsWrongIsReportedWithAllMistakesBeforeAnythingIsComputed) {
  std::filesystem::create_directories(folder_.path() / "checks");
  write(folder_.path() / "checks/bad_motor.toml", "name = \"x\"\nfigures = 3\n");
  std::string text;
  for (const char* command : {"evaluate --robot roboteam_twente_v2024 --duty division_a_match --sample 80",
                              "derate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --samples 100000",
                              "predict --model maxon_ec45_flat_70w_24v missing.csv", "friction --robot roboteam_twente_v2024 missing.csv",
                              "duty --robot roboteam_twente_v2024 --import missing.csv",
                              "simulate --motor bad_motor.toml --robot roboteam_twente_v2024 --duty division_a_match",
                              "evaluate --robot roboteam_twente_v2024 --duty division_a_match --motors no_such_motor --samples none"}) {
    text += fmt::format("[[check]]\nname = \"{0}\"\ncommand = \"{0}\"\n[check.limits]\nx = \"at most 1\"\n", command);
  }
  write(folder_.path() / "checks/a.check.toml", text + "[[check]]\nname = \"empty\"\n");
  const ProgramRun done = run({"check", "checks/a.check.toml"}, options_);
  EXPECT_EQ(done.exit_code, 2);
  const auto at = [](int check) { return fmt::format("checks/a.check.toml:{}:11: error: check[{}].command: ", 5 * check + 3, check); };
  EXPECT_THAT(done.err, HasSubstr(at(0)));
  EXPECT_THAT(done.err, HasSubstr("did you mean '--samples'"));
  EXPECT_THAT(done.err, testing::Not(HasSubstr(at(1))));
  for (const int missing : {2, 3, 4}) {
    EXPECT_THAT(done.err, HasSubstr(at(missing) + "checks/missing.csv: cannot be read")) << done.err;
  }
  EXPECT_THAT(done.err, HasSubstr("checks/bad_motor.toml:2:")) << "the place in the motor's own file";
  EXPECT_THAT(done.err, HasSubstr(at(6)));
  EXPECT_THAT(done.err, HasSubstr("check[7].limits: is missing")) << "a mistake of another kind";
}

TEST_F(CommandOfACheck, ThatFailsWhileItComputesFailsItsLimitsWithTheReason) {
  const ProgramRun done = checked("derate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --samples 20 --confidence 99.9%",
                                  "heat_reserve_ratio = \"at most 2\"\n");
  EXPECT_EQ(done.exit_code, 1) << done.err;
  EXPECT_THAT(std::regex_replace(done.out, std::regex("\\s+"), " "), HasSubstr("samples")) << done.out;
}

TEST_F(CommandOfACheck, RunsInTheFolderOfItsFileWithTheDataFolder) {
  std::filesystem::create_directories(folder_.path() / "checks/motors");
  std::filesystem::copy_file(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml", folder_.path() / "checks/motors/ours.toml");
  write(folder_.path() / "checks/a.check.toml",
        "[[check]]\nname = \"by path\"\ncommand = \"lint motors/ours.toml\"\n[check.limits]\nwarnings = \"at most 0\"\n"
        "[[check]]\nname = \"by id\"\ncommand = \"steady --motor ours --current-on 1A --time-on 1s --time-off 1s\"\n[check.limits]\n"
        "winding_C = \"at most 100 degC\"\n");
  const ProgramRun done = run({"check", "checks/a.check.toml", "--db", "checks/motors", "--json", "-"}, options_);
  EXPECT_THAT(done.out, testing::Not(HasSubstr("there is no motor"))) << done.err;
  const ordered_json answer = ordered_json::parse(done.out);
  EXPECT_TRUE(answer.at("thresholds").at(1).at("passed").get<bool>()) << answer;
}

TEST_F(CommandOfACheck, KnowsThePercentilesAndTheRestOfAMotor) {
  const std::string command =
      "evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors maxon_ecx_flat_42m_24v --samples 80";
  const ordered_json motor = ordered_json::parse(run_line("heatsoak " + command + " --json -", options_).out).at("motors").at(0);
  const ProgramRun done = checked(command,
                                  "motors.maxon_ecx_flat_42m_24v.winding_peak_C.p95 = \"at most 150 degC\"\n"
                                  "\"motors.*.rest_of_hot_motor.20min.rest_all_s\" = \"at most 600 s\"\n"
                                  "\"motors.*.time_to_limit_s\" = [\"at least 1 h\", \"at most 1 h\"]\n",
                                  {"--json", "-"});
  const ordered_json thresholds = ordered_json::parse(done.out).at("thresholds");
  EXPECT_EQ(thresholds.at(0).at("value"), motor.at("winding_peak_C").at("p95_ci95").at(1));
  EXPECT_GT(thresholds.at(0).at("value").get<double>(), motor.at("winding_peak_C").at("p95").get<double>());
  EXPECT_EQ(thresholds.at(1).at("value"), motor.at("rest_of_hot_motor").at(2).at("rest_all_s"));
  EXPECT_EQ(thresholds.at(1).at("unit"), "s");
  EXPECT_TRUE(motor.at("time_to_limit_s").is_null()) << "it never reaches a limit";
  EXPECT_TRUE(thresholds.at(2).at("passed").get<bool>());
  EXPECT_FALSE(thresholds.at(3).at("passed").get<bool>());
  EXPECT_TRUE(thresholds.at(3).at("evaluated").get<bool>());
}

TEST_F(CommandOfACheck, UpdateRewritesItsLimitOnceAndThenNothing) {
  const std::string command = "steady --motor maxon_ecx_flat_42m_24v --current-on 4A --time-on 1s --time-off 1s";
  EXPECT_EQ(checked(command, "winding_C = \"at most 30 degC\" # hot\n", {"--update"}).exit_code, 0);
  const std::string after = content_of(folder_.path() / "a.check.toml");
  EXPECT_THAT(after, HasSubstr(" degC\" # hot\n"));
  EXPECT_EQ(after.find("at most 30 degC"), std::string::npos);
  EXPECT_EQ(run({"check", "a.check.toml", "--update"}, options_).exit_code, 0);
  EXPECT_EQ(content_of(folder_.path() / "a.check.toml"), after);
}

}  // namespace
}  // namespace heatsoak
