// First steps of a new user: templates, pictures, terminals, interrupted commands.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string kEvaluate =
    "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors maxon_ecx_flat_32l_48v,maxon_ecx_flat_42m_24v "
    "--samples 120";

class FrontDoor : public testing::Test {
 protected:
  ProgramRun run_here(const std::string& line, const std::vector<std::string>& environment = {}) {
    RunOptions options;
    options.folder = folder_.path();
    options.environment = environment;
    options.environment.insert(options.environment.begin(), {"COLUMNS", "NO_COLOR"});
    return run_line(line, options);
  }
  [[nodiscard]] std::string file(const char* name) const { return content_of(folder_.path() / name); }
  TemporaryFolder folder_;
};

/// Fills the blank in the line of `key`, in front of the unit.
void fill(std::string& text, const std::string& key, const std::string& value) {
  text = std::regex_replace(text, std::regex("(\n" + key + " = [^\n?]*)\\?"), "$01" + value, std::regex_constants::format_first_only);
}

using Values = std::vector<std::pair<std::string, std::string>>;

std::string filled(std::string text, const Values& values) {
  for (const auto& [key, value] : values) {
    fill(text, key, value);
  }
  return text;
}

const Values kRobotValues{{"name", "mine"},
                          {"mass", "2.6"},
                          {"radius", "28"},
                          {"contact_radius", "80"},
                          {"axis_angles", "-30"},
                          {"axis_angles", "30"},
                          {"axis_angles", "135"},
                          {"axis_angles", "-135"},
                          {"motor", "maxon_ecx_flat_32l_48v"},
                          {"gear_ratio", "1"},
                          {"nominal_voltage", "22.2"}};

// The values come from the data sheet of the EC 45 flat.
TEST_F(FrontDoor, motor_template_passes_lint_once_it_is_filled_in) {
  ASSERT_EQ(run_here("heatsoak new motor mine.toml").exit_code, 0);
  write(folder_.path() / "mine.toml", filled(file("mine.toml"), {{"manufacturer", "maxon"},
                                                                 {"name", "EC 45 flat"},
                                                                 {"sheet", "catalogue page"},
                                                                 {"nominal_voltage", "24"},
                                                                 {"terminal_resistance", "0.608"},
                                                                 {"torque_constant", "36.9"},
                                                                 {"no_load_current", "234"},
                                                                 {"thermal_resistance_winding_stator", "4.1"},
                                                                 {"thermal_resistance_stator_ambient", "3.56"},
                                                                 {"thermal_time_constant_winding", "29.6"},
                                                                 {"thermal_time_constant_stator", "178"},
                                                                 {"winding_limit", "125"}}));
  const ProgramRun lint = run_here("heatsoak lint mine.toml");
  EXPECT_EQ(lint.exit_code, 0) << lint.out << lint.err;
  EXPECT_LE(run_here("heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors mine.toml").exit_code, 1);
}

TEST_F(FrontDoor, motor_template_works_with_its_optional_lines_too) {
  ASSERT_EQ(run_here("heatsoak new motor mine.toml").exit_code, 0);
  const std::string text = std::regex_replace(file("mine.toml"), std::regex("\n# ([a-z_]+ = )"), "\n$1");
  write(folder_.path() / "mine.toml", text);
  // Only the missing values are reported; keys and units are right.
  EXPECT_THAT(run_here("heatsoak lint mine.toml").err, AllOf(HasSubstr("figures.diameter.value"), Not(HasSubstr("is not a key"))));
}

TEST_F(FrontDoor, robot_template_passes_lint_once_it_is_filled_in) {
  ASSERT_EQ(run_here("heatsoak new robot mine.toml").exit_code, 0);
  write(folder_.path() / "mine.toml", filled(filled(file("mine.toml"), kRobotValues), {{"source", "measured"}}));
  const ProgramRun lint = run_here("heatsoak lint mine.toml");
  EXPECT_EQ(lint.exit_code, 0) << lint.out << lint.err;
}

TEST_F(FrontDoor, robot_template_passes_lint_with_its_optional_lines_too) {
  ASSERT_EQ(run_here("heatsoak new robot mine.toml").exit_code, 0);
  std::string text = std::regex_replace(file("mine.toml"), std::regex("\n# (\\[[a-z]+\\]|[a-z_]+ = )"), "\n$1");
  text = std::regex_replace(text, std::regex(R"re((source|derivation) = "\?")re"), "$1 = \"bench\"");
  const Values optional{{"inertia", "220"},
                        {"voltage_limit", "12.5"},
                        {"current_limit", "8"},
                        {"driver_resistance", "10"},
                        {"driver_standby_power", "0.5"},
                        {"full_voltage", "25.2"},
                        {"empty_voltage", "19.8"},
                        {"internal_resistance", "40"},
                        {"capacity", "1300"},
                        {"yaw_inertia", "0.011"},
                        {"center_of_gravity_height", "50"},
                        {"wheel_torque", "1"},
                        {"wheel_damping", "0.1"},
                        {"roller_drag", "0.16"},
                        {"coefficient", "0.7"},
                        {"slip_speed", "0.05"},
                        {"speed", "2"},
                        {"acceleration", "2"},
                        {"braking", "2"},
                        {"jerk", "6"},
                        {"yaw_rate", "6"},
                        {"yaw_acceleration", "30"}};
  write(folder_.path() / "mine.toml", filled(filled(text, kRobotValues), optional));
  const ProgramRun lint = run_here("heatsoak lint mine.toml");
  EXPECT_EQ(lint.exit_code, 0) << lint.out << lint.err;
  EXPECT_THAT(lint.out + lint.err, Not(HasSubstr("warning")));
}

// A match that starts would take seconds before it finds the next missing value.
TEST_F(FrontDoor, all_values_that_a_match_lacks_are_found_by_reading) {
  const auto without = [](std::string text, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
      text =
          std::regex_replace(text, std::regex(std::string("\n") + key + R"( = \{[^}]*\})"), "\n", std::regex_constants::format_first_only);
    }
    return text;
  };
  write(folder_.path() / "motor.toml", without(content_of(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml"), {"rotor_inertia"}));
  write(folder_.path() / "robot.toml",
        without(content_of(kSource / "robot_core/robots/tigers_v2020.toml"), {"driver_standby_power", "capacity"}));
  const std::string files = "--robot robot.toml --duty division_a_match ";
  for (const std::string& command : {"timeout 5 heatsoak simulate " + files + "--motor motor.toml",
                                     "timeout 5 heatsoak evaluate " + files + "--motors motor.toml --closed-loop"}) {
    const ProgramRun result = run_here(command);
    EXPECT_EQ(result.exit_code, 2) << command << result.err;
    for (const char* key : {"rotor_inertia", "drive.driver_standby_power", "battery.capacity"}) {
      EXPECT_THAT(result.err, HasSubstr(key)) << command;
    }
  }
  const ProgramRun lint = run_here("heatsoak lint motor.toml robot.toml");
  EXPECT_EQ(lint.exit_code, 0) << lint.err;
  EXPECT_THAT(lint.out, AllOf(HasSubstr("rotor_inertia"), HasSubstr("battery.capacity"), HasSubstr("match in closed loop")));
}

TEST_F(FrontDoor, templates_say_what_a_closed_loop_needs) {
  for (const char* kind : {"motor", "robot"}) {
    ASSERT_EQ(run_here(std::string("heatsoak new ") + kind + " " + kind + ".toml").exit_code, 0);
  }
  EXPECT_THAT(file("motor.toml"), testing::ContainsRegex("A match in closed loop needs it[^\n]*\n# rotor_inertia"));
  EXPECT_THAT(file("robot.toml"), testing::ContainsRegex("A match in closed loop[^\n]*\n# driver_resistance"));
}

TEST_F(FrontDoor, many_notes_of_lint_need_a_request) {
  const ProgramRun few = run_here("heatsoak lint " + (kSource / "motor_db").string());
  EXPECT_LT(std::ranges::count(few.out, '\n'), 20) << few.out;
  EXPECT_THAT(few.out, HasSubstr("--explain"));
  EXPECT_GT(run_here("heatsoak lint " + (kSource / "motor_db").string() + " --explain").out.size(), 2 * few.out.size());
}

TEST_F(FrontDoor, missing_and_unknown_words_are_explained) {
  EXPECT_THAT(run_here("heatsoak lint").err, HasSubstr("FILE is required: TOML files"));
  EXPECT_THAT(run_here("heatsoak log").err, HasSubstr("action is required: action on the logs; expected one of inspect, convert\n"));
  EXPECT_THAT(run_here("heatsoak new duty a.toml").err, HasSubstr("'duty' is not known; expected motor, robot"));
  EXPECT_THAT(run_here("heatsoak generate cores --robot a --motor b --out c").err, HasSubstr("'cores' is not known; expected core"));
}

// A template that is not filled in is bad input, whatever it describes.
TEST_F(FrontDoor, fresh_templates_are_bad_input) {
  for (const std::string kind : {"motor", "robot"}) {
    ASSERT_EQ(run_here(fmt::format("heatsoak new {0} {0}.toml", kind)).exit_code, 0);
    const ProgramRun lint = run_here(fmt::format("heatsoak lint {}.toml", kind));
    EXPECT_EQ(lint.exit_code, 2) << kind;
    EXPECT_THAT(lint.err, HasSubstr(fmt::format("{}.toml:", kind)));
    EXPECT_THAT(lint.err, HasSubstr("is still to be filled in"));
  }
}

TEST_F(FrontDoor, new_replaces_no_file) {
  write(folder_.path() / "mine.toml", "precious");
  EXPECT_EQ(run_here("heatsoak new motor mine.toml").exit_code, 2);
  EXPECT_EQ(file("mine.toml"), "precious");
}

TEST_F(FrontDoor, new_prints_a_hint_that_can_be_pasted) {
  EXPECT_THAT(run_here("heatsoak new motor 'a b.toml'").out, HasSubstr("`heatsoak lint 'a b.toml'`"));
  EXPECT_THAT(run_here("heatsoak new motor a.toml").out, HasSubstr("`heatsoak lint a.toml`"));
  const ProgramRun nameless = run_here("heatsoak new robot .toml");
  EXPECT_EQ(nameless.exit_code, 2);
  EXPECT_THAT(nameless.err, HasSubstr("the part before .toml is the id"));
}

TEST_F(FrontDoor, one_motor_is_one_motor_and_few_samples_have_no_range) {
  const std::string line = "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors maxon_ecx_flat_32l_48v";
  EXPECT_THAT(run_here(line + " --quiet").out, StartsWith("0 of 1 motor passes paper_intermittent"));
  const std::string single = run_here("COLUMNS=200 " + line + " --samples 1").out;
  EXPECT_THAT(single, AllOf(HasSubstr("1 sample of all"), HasSubstr("  162 "), Not(HasSubstr("162 ["))));
}

TEST_F(FrontDoor, a_report_can_go_to_stdout) {
  const ProgramRun done = run_here(kEvaluate + " --report -");
  EXPECT_THAT(done.out, HasSubstr("| motor |"));
  EXPECT_THAT(done.out, Not(HasSubstr("--explain")));
}

TEST_F(FrontDoor, changes_that_help_follow_every_verdict) {
  const std::string line = "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors ";
  const ProgramRun passes = run_here(line + "maxon_ecx_flat_42m_24v");
  EXPECT_THAT(passes.out,
              AllOf(HasSubstr("Changes of the robot that help maxon_ecx_flat_42m_24v most"), Not(HasSubstr("Largest improvement"))));
  const ProgramRun fails = run_here(line + "maxon_ecx_flat_32l_48v");
  EXPECT_THAT(fails.out, AllOf(HasSubstr("Changes of the robot that help maxon_ecx_flat_32l_48v most"), HasSubstr("Largest improvement")));
  EXPECT_THAT(run_here(line + "maxon_ecx_flat_42m_24v --no-changes").out, Not(HasSubstr("Changes of the robot")));
  EXPECT_THAT(run_here(line + "maxon_ecx_flat_32l_48v --quiet").out, HasSubstr("Largest improvement"));
  // A report and JSON contain the table whatever the terminal shows.
  EXPECT_THAT(run_here(line + "maxon_ecx_flat_42m_24v --quiet --report -").out, HasSubstr("Changes of the robot"));
  EXPECT_THAT(run_here(line + "maxon_ecx_flat_42m_24v --quiet --json -").out, HasSubstr("\"changes\""));
}

TEST_F(FrontDoor, every_kind_of_error_of_a_motor_file_is_reported_at_once) {
  std::string text = content_of(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  const auto change = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  change("name = ", "nmae = ");            // wrong key
  change("\"0.463 mH\"", "\"0.463 mV\"");  // wrong unit
  change("mass = { value = \"141 g\", origin = \"datasheet\", source = \"maxon_2019\"",
         "mass = { value = \"141 g\", origin = \"datasheet\", source = \"nowhere\"");
  change("\"259 rpm/V\"", "\"100 rpm/V\"");   // contradiction
  change("\"1460 mN m\"", "\"14600 mN m\"");  // another contradiction
  change("\"0.234 A\", origin = \"datasheet\", source = \"maxon_2019\"",
         "\"-0.234 A\", origin = \"datasheet\", source = \"shet\"");  // two mistakes in one entry
  text += "\n[effects.no_such_effect]\nsize = \"1\"\n";               // unknown effect
  write(folder_.path() / "mine.toml", text);
  for (const char* command :
       {"heatsoak lint mine.toml", "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors mine.toml"}) {
    const ProgramRun result = run_here(command);
    EXPECT_EQ(result.exit_code, 2);
    for (const char* said : {"nmae", "terminal_inductance", "'nowhere' is not in [sources]", "'shet' is not in [sources]",
                             "constants: ", "stall_torque: ", "no_such_effect"}) {
      EXPECT_THAT(result.err, HasSubstr(said)) << command;
    }
  }
}

TEST_F(FrontDoor, output_is_as_wide_as_columns_says) {
  for (const int width : {80, 100, 160}) {
    const ProgramRun result = run_here("COLUMNS=" + std::to_string(width) + " " + kEvaluate + " --explain");
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }), width) << line;
    }
  }
  EXPECT_THAT(run_here("COLUMNS=160 " + kEvaluate).out, HasSubstr("limited by"));
  EXPECT_THAT(run_here(kEvaluate).out, Not(HasSubstr("limited by")));
}

TEST_F(FrontDoor, all_motors_fit_eighty_columns) {
  std::istringstream lines(run_here("heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --samples 0").out);
  std::set<std::string> names;
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }), 80) << line;
    EXPECT_THAT(line, Not(HasSubstr("…  "))) << "a name is shortened in its middle";
    if (std::smatch row; std::regex_search(line, row, std::regex("^ *[0-9]+  (\\S+)"))) {
      ++rows;
      names.insert(row[1]);
      EXPECT_THAT(line, testing::ContainsRegex("[▁▂▃▄▅▆▇█]$")) << "the curve of the winding";
    }
  }
  EXPECT_GT(rows, 20U);
  EXPECT_EQ(names.size(), rows);
}

TEST_F(FrontDoor, a_fixed_load_says_first_that_the_robot_does_not_matter) {
  EXPECT_THAT(
      run_here(kEvaluate + " --quiet").out,
      AllOf(StartsWith("1 of 2 motors passes paper_intermittent (a fixed wheel load: mass and"), HasSubstr("of the robot do not matter)")));
}

TEST_F(FrontDoor, colours_are_for_terminals_that_want_them) {
  const std::string on_terminal = "script -qec '" + kEvaluate + "' /dev/null";
  EXPECT_THAT(run_here(on_terminal, {"TERM=xterm"}).out, HasSubstr("\x1b[32m"));
  EXPECT_THAT(run_here(on_terminal, {"TERM=xterm", "NO_COLOR=1"}).out, Not(HasSubstr("\x1b[3")));
  EXPECT_THAT(run_here(kEvaluate, {"TERM=xterm"}).out, Not(HasSubstr("\x1b[")));
}

TEST_F(FrontDoor, report_holds_every_column) {
  ASSERT_LE(run_here(kEvaluate + " --report answer.md").exit_code, 1);
  EXPECT_THAT(file("answer.md"),
              AllOf(HasSubstr("| motor | verdict |"), HasSubstr("limited by"), HasSubstr("maxon\\_ecx\\_flat\\_42m\\_24v")));
  EXPECT_EQ(run_here(kEvaluate + " --report answer.docx").exit_code, 2);
}

/// Answers of verbs that need neither a log nor a long computation.
const std::vector<std::string> kShortAnswers{
    "heatsoak list motors",
    "heatsoak list effects",
    "heatsoak describe maxon_ecx_flat_32l_48v",
    "heatsoak describe division_a_match",
    "heatsoak describe roboteam_twente_v2024",
    "heatsoak describe robot_core",
    "heatsoak describe verdict",
    "heatsoak lint roboteam_twente_v2024",
    "heatsoak simulate --motor maxon_ecx_flat_42m_24v --robot roboteam_twente_v2024 --duty paper_intermittent",
    "heatsoak duty --duty paper_intermittent --robot roboteam_twente_v2024",
};

TEST_F(FrontDoor, every_answer_fits_a_narrow_terminal) {
  for (const std::string& command : kShortAnswers) {
    for (const int width : {60, 80, 140}) {
      const ProgramRun result = run_here("COLUMNS=" + std::to_string(width) + " " + command + " --explain");
      ASSERT_EQ(result.exit_code, 0) << command << result.err;
      std::istringstream lines(result.out);
      for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }), width)
            << command << ": " << line;
      }
    }
  }
}

TEST_F(FrontDoor, a_list_in_a_pipe_has_one_line_per_name) {
  for (const std::string kind : {"duties", "effects", "motors"}) {
    const std::string names = run_here("heatsoak list " + kind + " --quiet").out;
    const std::string list = run_here("heatsoak list " + kind).out;
    EXPECT_EQ(std::ranges::count(list, '\n'), std::ranges::count(names, '\n')) << list;
  }
}

TEST_F(FrontDoor, a_width_below_the_least_is_the_least) {
  for (const std::string& command : kShortAnswers) {
    const ProgramRun least = run_here("COLUMNS=20 " + command);
    ASSERT_EQ(least.exit_code, 0) << command << least.err;
    for (const char* width : {"1", "10"}) {
      const ProgramRun result = run_here("COLUMNS=" + std::string(width) + " " + command);
      EXPECT_EQ(result.exit_code, 0) << command << result.err;
      EXPECT_EQ(result.out, least.out) << command;
    }
  }
}

TEST_F(FrontDoor, every_answer_has_a_short_form_and_a_document) {
  for (const std::string& command : kShortAnswers) {
    const ProgramRun quiet = run_here(command + " --quiet");
    EXPECT_FALSE(quiet.out.empty()) << command;
    EXPECT_LT(quiet.out.size(), run_here(command + " --explain").out.size() + 1) << command;
    ASSERT_EQ(run_here(command + " --report answer.md").exit_code, 0) << command;
    ASSERT_EQ(run_here(command + " --report answer.html").exit_code, 0) << command;
    EXPECT_THAT(file("answer.html"), StartsWith("<!DOCTYPE html>")) << command;
    EXPECT_FALSE(file("answer.md").empty()) << command;
  }
}

TEST_F(FrontDoor, a_quiet_list_is_for_scripts) {
  std::istringstream names(run_here("heatsoak list topics --quiet").out);
  int count = 0;
  for (std::string name; std::getline(names, name); ++count) {
    EXPECT_EQ(name.find(' '), std::string::npos) << name;
  }
  EXPECT_GT(count, 10);
}

TEST_F(FrontDoor, verdicts_are_described) {
  const ProgramRun text = run_here("heatsoak describe verdict");
  for (const char* word : {"\npass ", "\nmarginal ", "\nfail ", "\ninfeasible ", "\nundecided "}) {
    EXPECT_THAT(text.out, HasSubstr(word));
  }
  EXPECT_EQ(run_here("heatsoak describe verdict --json -").json().at("verdicts").size(), 4U);
}

TEST_F(FrontDoor, pictures_are_drawn_as_png_too) {
  ASSERT_LE(run_here(kEvaluate + " --plot verdict.png", {"DISPLAY", "WAYLAND_DISPLAY"}).exit_code, 1);
  const std::string png = file("verdict.png");
  ASSERT_GT(png.size(), 10'000U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  // The first chunk contains width and height, most significant byte first. Two pixels stand for one unit of the SVG's 1000.
  const auto at = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(png[i])); };
  EXPECT_EQ((at(18) << 8U) + at(19), 2000U);
}

TEST_F(FrontDoor, an_interrupted_command_leaves_nothing) {
  const std::string robot = " --robot roboteam_twente_v2024 --duty division_a_match";
  for (const std::string& line :
       std::vector<std::string>{"timeout -s INT 1 heatsoak evaluate" + robot + " --samples 2000 --plot p.svg --json a.json",
                                "timeout -s INT 1 heatsoak simulate --motor maxon_ecx_flat_32l_48v" + robot + " --out t.csv --plot t.svg",
                                "timeout -s INT 1 heatsoak generate core --robot roboteam_twente_v2024 --motor maxon_ecx_flat_32l_48v "
                                "--samples 20000 --out core"}) {
    EXPECT_EQ(run_here(line).exit_code, 124) << line << " ended before it was interrupted";
    EXPECT_THAT(folder_.names(), IsEmpty()) << line;
  }
}

TEST_F(FrontDoor, an_interrupt_on_a_terminal_ends_the_progress_line) {
  const ProgramRun result = run_here(
      "script -qec 'timeout --foreground -s INT 2 heatsoak evaluate --robot roboteam_twente_v2024 --duty "
      "division_a_match --samples 4000' /dev/null");
  EXPECT_TRUE(result.out.ends_with("interrupted\r\n")) << result.out;
}

// A team's CI must not accept a verdict that more samples could change, and its scripts must not see the verdict come and go.
TEST_F(FrontDoor, an_undecided_motor_is_marginal_whatever_the_number_of_samples) {
  const std::string line =
      "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors nanotec_df45l024048_a2 --json - --samples ";
  for (const std::string samples : {"0", "8", "60"}) {
    const ProgramRun usual = run_here(line + samples);
    EXPECT_EQ(usual.exit_code, 0) << samples;
    EXPECT_EQ(usual.json().at("motors").at(0).at("verdict"), "marginal") << samples;
    EXPECT_EQ(usual.json().at("motors").at(0).at("decided"), false) << samples;
    EXPECT_EQ(run_here(line + samples + " --fail-on marginal").exit_code, 1) << samples;
  }
  EXPECT_EQ(run_here(line + "4000 --fail-on marginal").exit_code, 0);
}

// The computation takes seconds to minutes, so the user learns first that there will be no picture.
TEST_F(FrontDoor, a_missing_drawing_library_is_reported_before_the_computation) {
  fs::create_directory(folder_.path() / "bin");
  fs::copy_file(HEATSOAK_PROGRAM, folder_.path() / "bin" / "heatsoak");
  const std::string words = " evaluate --robot roboteam_twente_v2024 --duty division_a_match --samples 80000 --db " + kSource.string();
  const ProgramRun result = run_here("timeout 20 bin/heatsoak" + words + " --plot verdict.svg", {"HEATSOAK_PLUGINS"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("is missing, which --plot needs"), HasSubstr("without a picture")));
  EXPECT_LT(result.err.find("is missing"), result.err.find("leave out --plot")) << "the fault before the remedy";
  EXPECT_EQ(run_here("timeout 20 bin/heatsoak" + words + " --report verdict.html", {"HEATSOAK_PLUGINS"}).exit_code, 2);
}

TEST_F(FrontDoor, help_fits_the_terminal) {
  for (const std::string& verb : std::vector<std::string>{"", "evaluate", "calibrate", "log", "diagnose"}) {
    std::istringstream lines(run_here("heatsoak " + verb + " --help").out);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }), 80) << line;
      EXPECT_THAT(line, Not(HasSubstr("... ..."))) << verb;
    }
  }
}

TEST_F(FrontDoor, undecided_verdicts_ask_for_more_samples) {
  // The probability of exceeding the limit is near the threshold of 5 %.
  const std::string line = "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors nanotec_df45l024048_a2";
  const ProgramRun few = run_here(line + " --samples 60 --json -");
  const nlohmann::json before = few.json().at("motors").at(0);
  ASSERT_TRUE(before.at("samples_needed").is_number()) << few.err;
  EXPECT_THAT(few.err, AllOf(HasSubstr("undecided"), HasSubstr("more samples")));
  const nlohmann::json after = run_here(line + " --json -").json().at("motors").at(0);
  EXPECT_TRUE(after.at("samples_needed").is_null());
  EXPECT_GT(after.at("samples"), 500);
  const double low = after.at("probability_ci95").at(0);
  const double high = after.at("probability_ci95").at(1);
  EXPECT_TRUE(low > 0.05 || high <= 0.05) << low << " " << high;
}

TEST_F(FrontDoor, man_pages_exist_for_every_verb) {
  ASSERT_EQ(run_here("heatsoak manual --to man --out man1").exit_code, 0);
  EXPECT_THAT(file("man1/heatsoak-evaluate.1"), AllOf(StartsWith(".TH \"HEATSOAK\\-EVALUATE\" 1"), HasSubstr(".B \\-\\-robot R\n")));
  if (run_here("command -v groff").exit_code == 0) {
    EXPECT_THAT(run_here("groff -K utf8 -man -ww -z man1/*.1").err, IsEmpty());
  }
}

}  // namespace
}  // namespace heatsoak
