// Outputs to places that are not writable, and the environment of the process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "short_runs.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

// Outputs to places that are not writable.

TEST(Unwritable, one_of_several_outputs_leaves_none_of_them) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  for (const Words& words : {kShortEvaluate + Words{"--samples", "0", "--plot", "p.svg", "--json", "no_such_folder/a.json"},
                             kShortSimulate + Words{"--out", "x.csv", "--plot", "no_such_folder/p.svg"},
                             kShortSimulate + Words{"--out", "same.svg", "--plot", "./same.svg"}}) {
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
    for (const Words& words : {kShortSteady + Words{"--json", target}, kShortEvaluate + Words{"--samples", "0", "--plot", target},
                               kShortSimulate + Words{"--out", target}, kShortSimulate + Words{"--plot", target}}) {
      const ProgramRun result = run(words, inside);
      EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(words) << result.err;
      EXPECT_THAT(result.err, testing::AnyOf(HasSubstr("writ"), HasSubstr("end in .svg or .png"))) << target;
      EXPECT_THAT(folder.names(), UnorderedElementsAre("taken.svg")) << target;
    }
  }
  EXPECT_TRUE(fs::is_empty(folder.path() / "taken.svg"));
}

// A log that cannot be read is reported by the computation; the output is refused before it.
TEST(Unwritable, target_is_refused_before_the_computation) {
  const TemporaryFolder folder;
  const std::string motor = "maxon_ec45_flat_70w_24v";
  write(folder.path() / "model.toml", content_of(kSource / "motor_db" / (motor + ".toml")));
  write(folder.path() / (motor + ".toml"), content_of(kSource / "motor_db" / (motor + ".toml")));
  const RunOptions inside{.folder = folder.path()};
  const std::vector<std::string> before = folder.names();
  const auto expect_refused = [&](const Words& words, const char* says) {
    const ProgramRun result = run(words, inside);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.err, testing::AllOf(HasSubstr(says), Not(HasSubstr("missing.csv")))) << testing::PrintToString(words);
    EXPECT_EQ(folder.names(), before);
  };
  const Words diagnose{"diagnose", "--train", "missing.csv", "--model"};
  const Words calibrate{"calibrate", "missing.csv", "--motor"};
  expect_refused(diagnose + Words{motor, "--out", "/proc/x/y"}, "the folder cannot be made");
  expect_refused(diagnose + Words{"model.toml", "--out", "model.toml"}, "the folder cannot be made");
  expect_refused(diagnose + Words{"./" + motor + ".toml", "--out", "."}, "this command reads the file and would overwrite it");
  expect_refused(diagnose + Words{motor, "--out", "new", "--report", "no_such_folder/a.md"}, "cannot be written");
  expect_refused(calibrate + Words{motor, "--out", "/no_such_folder/x.toml"}, "cannot be written");
  expect_refused(calibrate + Words{"model.toml", "--out", "model.toml"}, "this command reads the file and would overwrite it");
  expect_refused(calibrate + Words{motor, "--out", "x.toml", "--json", "model.toml"}, "--json would overwrite it");
}

TEST(Unwritable, full_disk_is_reported_and_the_device_survives) {
  RunOptions full;
  full.stdout_file = "/dev/full";
  for (const Words& words :
       {kShortSteady, kShortSteady + Words{"--json", "-"}, Words{"list", "motors"}, Words{"completion"}, Words{"--version"}}) {
    const ProgramRun result = run(words, full);
    EXPECT_EQ(result.exit_code, 2) << words[0] << result.err;
    EXPECT_THAT(result.err, HasSubstr("stdout cannot be written"));
  }
  const ProgramRun result = run(kShortSteady + Words{"--json", "/dev/full"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("No space left"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(Unwritable, closed_stdout_is_named) {
  const ProgramRun result = run_line("heatsoak list motors >&-");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("stdout is closed"));
}

TEST(Unwritable, stderr_does_not_crash_it) {
  RunOptions full;
  full.stderr_file = "/dev/full";
  EXPECT_EQ(run({"evaluat"}, full).exit_code, 2);
  EXPECT_EQ(run(kShortSteady + Words{"--json", "-"}, full).exit_code, 0);
}

TEST(Output, keeps_links_and_devices) {
  const TemporaryFolder folder;
  write(folder.path() / "real.json", "old");
  fs::create_symlink("real.json", folder.path() / "link.json");
  RunOptions inside;
  inside.folder = folder.path();
  EXPECT_EQ(run(kShortSteady + Words{"--json", "link.json"}, inside).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.json"));
  EXPECT_TRUE(json::parse(content_of(folder.path() / "real.json")).contains("schema"));
  EXPECT_EQ(run(kShortSteady + Words{"--json", "/dev/null"}, inside).exit_code, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  fs::create_symlink("later.json", folder.path() / "dangling.json");
  EXPECT_EQ(run(kShortSteady + Words{"--json", "dangling.json"}, inside).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "dangling.json"));
  EXPECT_TRUE(json::parse(content_of(folder.path() / "later.json")).contains("schema"));
  EXPECT_THAT(folder.names(), UnorderedElementsAre("dangling.json", "later.json", "link.json", "real.json"));
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
        Two{kShortSimulate + Words{"--out", "new.csv", "--json", "./new.csv"}, "--out and --json name one file"},
        Two{kShortSimulate + Words{"--out=new.csv", "--json=new.csv"}, "--out and --json name one file"},
        Two{kShortEvaluate + Words{"--plot", "link.svg", "--json", "mine.json"}, "--plot and --json name one file"},
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
  const ProgramRun result = run(kShortEvaluate + Words{"--samples", "5", "--plot", "verdict.svg"}, bare);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.err, "");  // no progress bar without a terminal
  EXPECT_THAT(result.out, Not(HasSubstr("\x1b[")));
  EXPECT_THAT(content_of(folder.path() / "verdict.svg"), HasSubstr("<svg"));
  EXPECT_THAT(folder.names(), UnorderedElementsAre("verdict.svg"));
  RunOptions coloured;
  coloured.environment = {"TERM=xterm-256color"};
  EXPECT_THAT(run(kShortEvaluate + Words{"--samples", "5"}, coloured).out, Not(HasSubstr("\x1b[")));
}

TEST(Surroundings, a_locale_with_a_decimal_comma_changes_nothing) {
  RunOptions german;
  german.environment = {"LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"};
  EXPECT_EQ(run(kShortSteady + Words{"--json", "-"}, german).out, run(kShortSteady + Words{"--json", "-"}).out);
}

TEST(Surroundings, any_working_directory) {
  RunOptions at_root;
  at_root.folder = "/";
  EXPECT_EQ(run(kShortSteady, at_root).out, run(kShortSteady).out);
}

}  // namespace
}  // namespace heatsoak
