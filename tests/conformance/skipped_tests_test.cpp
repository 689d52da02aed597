// List of skipped tests at the end of `./bootstrap test`, and the skips that fail in CI.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "program_run.h"
#include "support/measured_data.h"
#include "support/skip_reasons.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Sets or removes HEATSOAK_MEASURED_DATA until the end of its life.
class StatedData {
 public:
  explicit StatedData(const char* folder) {
    if (const char* const before = std::getenv(kName)) {
      before_ = before;
    }
    set(folder);
  }
  StatedData(const StatedData&) = delete;
  StatedData& operator=(const StatedData&) = delete;
  ~StatedData() { set(before_ ? before_->c_str() : nullptr); }

 private:
  static constexpr const char* kName = "HEATSOAK_MEASURED_DATA";
  static void set(const char* value) { value != nullptr ? ::setenv(kName, value, 1) : ::unsetenv(kName); }
  std::optional<std::string> before_;
};

void body_of_a_test(const std::string& folder) { SKIP_WITHOUT_MEASURED_DATA(folder); }

/// Returns what GoogleTest prints when a test needs recordings of this folder and HEATSOAK_MEASURED_DATA is as given.
std::string skip_without(const char* data, const std::string& folder) {
  const StatedData stated(data);
  testing::TestPartResultArray results;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD,
                                                             &results);
    body_of_a_test(folder);
  }
  EXPECT_EQ(results.size(), 1);
  EXPECT_TRUE(results.size() == 1 && results.GetTestPartResult(0).skipped());
  return results.size() == 0 ? "" : fmt::format("/x/test.cpp:66: Skipped\n{}\n\n", results.GetTestPartResult(0).message());
}

std::string ran(const std::string& name, const std::string& printed) {
  return fmt::format("[ RUN      ] {0}\n{1}[  SKIPPED ] {0} (0 ms)\n", name, printed);
}

/// Returns a log of CTest with these names and outputs of tests.
std::string log_of(const std::vector<std::pair<std::string, std::string>>& tests) {
  std::string log = "Start testing: Nov 27 13:36 UTC\n";
  for (const auto& [name, output] : tests) {
    log += fmt::format("1/9 Testing: {0}\n1/9 Test: {0}\nCommand: \"x\"\nOutput:\n-----\n{1}<end of output>\n", name, output);
  }
  return log;
}

ProgramRun list_skipped(const std::string& log, const std::string& ci) {
  const TemporaryFolder folder;
  write(folder.path() / "LastTest.log", log);
  return run_line(fmt::format("'{}/.ci/list_skipped' LastTest.log", kSource.string()), {.folder = folder.path(), .environment = {ci}});
}

const std::string kLog = log_of({{"base.A.passes", "[ RUN      ] A.passes\n[       OK ] A.passes (0 ms)\n"},
                                 {"target.Core.runs", ran("Core.runs", "/x/emulator.h:20: Skipped\n" HEATSOAK_FAILS_CI "no compiler\n\n")},
                                 {"target.Records/Match", "/x/emulator.h:20: Skipped\n" HEATSOAK_FAILS_CI "no compiler\n\n"},
                                 {"derate.part_0", ran("Fmu.reader", "/x/fmu.cpp:1: Skipped\nno fmpy\n\n")}});

TEST(SkippedTests, are_listed_by_reason_and_pass_outside_of_ci) {
  const ProgramRun listed = list_skipped(kLog, "CI");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr("  2 skipped: [fails CI] no compiler\n    target.Core.runs\n    target.Records/Match\n"));
  EXPECT_THAT(listed.out, HasSubstr("  1 skipped: no fmpy\n    derate.part_0/Fmu.reader\n"));
  EXPECT_THAT(listed.out, Not(HasSubstr("passes")));
  EXPECT_THAT(listed.out, Not(HasSubstr("CI fails")));
}

TEST(SkippedTests, fail_ci_with_the_same_list_if_something_promised_is_missing) {
  const ProgramRun listed = list_skipped(kLog, "CI=true");
  EXPECT_EQ(listed.exit_code, 1) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr(list_skipped(kLog, "CI").out));
  EXPECT_THAT(listed.out, HasSubstr("CI fails: 2 skipped tests"));
}

TEST(SkippedTests, pass_in_ci_for_other_reasons_and_without_skips) {
  const ProgramRun others = list_skipped(log_of({{"derate.part_0", ran("Fmu.reader", "/x/fmu.cpp:1: Skipped\nno fmpy\n\n")}}), "CI=true");
  EXPECT_EQ(others.exit_code, 0) << others.err;
  EXPECT_THAT(others.out, HasSubstr("1 skipped: no fmpy"));
  const ProgramRun none = list_skipped(log_of({{"base.A.passes", "[       OK ] A.passes (0 ms)\n"}}), "CI=true");
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_THAT(none.out, IsEmpty());
}

TEST(SkippedTests, for_want_of_a_consumer_name_it_once_and_the_command_that_runs_it) {
  const std::string moteus = "/x/a.cpp:1: Skipped\n" HEATSOAK_LACKS_CONSUMER("moteus") "X is not set\n\n";
  const std::string fmpy = "/x/b.cpp:1: Skipped\n" HEATSOAK_LACKS_CONSUMER("fmpy") "python3 has no fmpy\n\n";
  const std::string log = log_of({{"derate.part_0", ran("A.a", moteus) + ran("B.b", fmpy) + ran("B.c", fmpy)}});
  for (const char* const ci : {"CI", "CI=true"}) {
    const ProgramRun listed = list_skipped(log, ci);
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    EXPECT_THAT(listed.out, testing::EndsWith("\nNot tested, because not installed: moteus fmpy. To install and run them: "
                                              "tests/derate/consumers/run moteus fmpy\n"));
  }
  EXPECT_THAT(list_skipped(kLog, "CI").out, Not(HasSubstr("Not tested")));
}

// The script refuses a name that it does not know, and --help after the names ends it before it fetches anything.
TEST(SkippedTests, name_consumers_that_the_script_installs) {
  const std::filesystem::path tests = kSource / "tests/derate";
  std::string names;
  for (const std::filesystem::directory_entry& file : std::filesystem::directory_iterator(tests)) {
    const std::string text = file.is_regular_file() ? content_of(file.path()) : std::string();
    static const std::regex kName("HEATSOAK_LACKS_CONSUMER\\(\"(\\w+)\"\\)");
    for (std::sregex_iterator found(text.begin(), text.end(), kName); found != std::sregex_iterator(); ++found) {
      names += " " + (*found)[1].str();
    }
  }
  EXPECT_THAT(names, HasSubstr("moteus"));
  const ProgramRun known = run_line(fmt::format("'{}/consumers/run'{} --help", tests.string(), names));
  EXPECT_EQ(known.exit_code, 0) << known.err;
  EXPECT_EQ(run_line(fmt::format("'{}/consumers/run' no_such_consumer --help", tests.string())).exit_code, 2);
}

TEST(SkippedTests, need_a_log) {
  const ProgramRun run = run_line(fmt::format("'{}/.ci/list_skipped' no_such_file", kSource.string()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("no_such_file"));
}

TEST(SkippedTests, for_recordings_that_the_variable_lacks_fail_ci) {
  const std::string printed = skip_without("/no/such/folder", "uav");
  EXPECT_THAT(printed, HasSubstr("HEATSOAK_MEASURED_DATA=/no/such/folder has no recordings of uav"));
  EXPECT_EQ(list_skipped(log_of({{"a.B.c", ran("B.c", printed)}}), "CI=true").exit_code, 1);
  EXPECT_EQ(list_skipped(log_of({{"a.B.c", ran("B.c", printed)}}), "CI").exit_code, 0);
}

TEST(SkippedTests, for_missing_recordings_fail_ci_without_the_variable_too) {
  const std::string printed = skip_without(nullptr, "no_such_recordings");
  EXPECT_THAT(printed, HasSubstr("no recordings of no_such_recordings"));
  EXPECT_EQ(list_skipped(log_of({{"a.B.c", ran("B.c", printed)}}), "CI=true").exit_code, 1);
  EXPECT_EQ(list_skipped(log_of({{"a.B.c", ran("B.c", printed)}}), "CI").exit_code, 0);
}

}  // namespace
}  // namespace heatsoak
