// Logs named by the user: parts, and equal names in different folders.
#include "recording/named_logs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostic.h"

namespace heatsoak::recording {
namespace {

namespace fs = std::filesystem;

/// Reads logs and throws the problems of all of them.
NamedLogs read_all(const std::vector<std::string>& fitted, const std::vector<std::string>& held_out, const LogChoice& choice) {
  NamedLogs logs = read_usable_logs(fitted, held_out, choice);
  logs.unread.throw_if_any();
  return logs;
}

class NamedLogsTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* const day : {"monday", "tuesday"}) {
      fs::create_directories(folder_ / day);
      std::ofstream out(folder_ / day / "run.csv");
      out << "time_s,current_A,winding_C\n";
      for (int second = 0; second <= 100; ++second) {
        out << second << "," << (second % 7) << "," << 25.0 + 0.1 * second + (day[0] == 'm' ? 0.0 : 1.0) << "\n";
      }
    }
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string log(const char* day) const { return (folder_ / day / "run.csv").string(); }

 private:
  fs::path folder_ = fs::path(testing::TempDir()) / ("named_logs_" + std::to_string(getpid()));
};

TEST_F(NamedLogsTest, EqualNamesGetTheirFoldersAndFittedOnesIgnoreTheHoldOut) {
  const NamedLogs both = read_all({log("monday"), log("tuesday")}, {}, {});
  EXPECT_EQ(both.fitted[0].name, "monday/run");
  EXPECT_EQ(both.fitted[1].name, "tuesday/run");
  const NamedLogs apart = read_all({log("monday")}, {log("tuesday")}, {});
  EXPECT_EQ(apart.fitted[0].name, "run");
  EXPECT_EQ(apart.held_out[0].name, "tuesday/run");
}

TEST_F(NamedLogsTest, PartsOfOneLogKeepItsNameAndShareTheTime) {
  const NamedLogs parts = read_all({log("monday") + "@0-60%"}, {log("monday") + "@60-100%"}, {});
  EXPECT_EQ(parts.fitted[0].name, "run");
  EXPECT_EQ(parts.held_out[0].name, "run");
  EXPECT_NEAR(parts.fitted[0].time_s.back(), 60.0, 1.0);
  EXPECT_NEAR(parts.held_out[0].time_s.front(), 60.0, 1.0);
  EXPECT_EQ(parts.readings.size(), 1U) << "the report of the whole log would be printed once per part";
  EXPECT_TRUE(parts.fitted[0].blocking_of_whole);
  EXPECT_THROW(read_all({log("monday") + "@70-20%"}, {}, {}), base::Failure);
}

TEST_F(NamedLogsTest, SeveralPartsOfOneLogAreNamedWithTheirPart) {
  const NamedLogs parts = read_all({log("monday") + "@0-20%", log("monday") + "@20-40%", log("tuesday") + "@0-20%"},
                                   {log("monday") + "@60-80%", log("monday") + "@80-100%"}, {});
  EXPECT_EQ(parts.fitted[0].name, "monday/run@0-20%");
  EXPECT_EQ(parts.fitted[1].name, "monday/run@20-40%");
  EXPECT_EQ(parts.fitted[2].name, "tuesday/run");
  EXPECT_EQ(parts.held_out[0].name, "monday/run@60-80%");
  EXPECT_EQ(parts.held_out[1].name, "monday/run@80-100%");
}

TEST_F(NamedLogsTest, TheRefusalOfAPartSaysWhatIsWrongWithIt) {
  for (const auto& [part, says] : {std::pair("@60-40%", "the part ends at 40 %, before its begin at 60 %; expected LOG@FROM-TO%"),
                                   std::pair("@50-50%", "the part begins and ends at 50 %; expected"),
                                   std::pair("@0-150%", "the part is not within 0 to 100 % of the log"),
                                   std::pair("@0-nan%", "the part has no number")}) {
    try {
      read_all({log("monday") + part}, {}, {});
      FAIL() << part;
    } catch (const base::Failure& failure) {
      EXPECT_THAT(failure.what(), testing::HasSubstr(says));
    }
  }
}

TEST_F(NamedLogsTest, APartThatIsNoneOrHasNoRowsIsRefused) {
  for (const std::string part : {"@0-nan%", "@nan-50%", "@0-inf%", "@x-50%", "@50.1-50.2%"}) {
    try {
      read_all({log("monday") + part}, {}, {});
      FAIL() << part;
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      EXPECT_THAT(failure.what(), testing::HasSubstr(part == "@50.1-50.2%" ? "has 0 of the log's 101 rows" : "expected LOG@FROM-TO%"));
    }
  }
}

TEST_F(NamedLogsTest, FailuresOfUnreadLogsAreKeptBesideTheOthers) {
  const NamedLogs logs = read_usable_logs({log("sunday"), log("monday")}, {log("saturday")}, {});
  ASSERT_EQ(logs.fitted.size(), 1U);
  EXPECT_EQ(logs.fitted[0].name, "run");
  EXPECT_TRUE(logs.held_out.empty());
  EXPECT_FALSE(logs.unread.empty());
  EXPECT_THROW(logs.unread.throw_if_any(), base::SeveralFailures);
}

TEST_F(NamedLogsTest, ProblemsOfAllLogsAreReportedOnce) {
  try {
    read_all({log("sunday"), log("monday"), log("monday") + "@70-20%"}, {log("sunday"), log("saturday")}, {});
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    ASSERT_EQ(failure.diagnostics().size(), 3U);
    EXPECT_EQ(failure.diagnostics()[0].at.file, log("sunday"));
    EXPECT_THAT(failure.diagnostics()[1].message, testing::HasSubstr("expected LOG@FROM-TO%"));
    EXPECT_EQ(failure.diagnostics()[2].at.file, log("saturday"));
  }
}

}  // namespace
}  // namespace heatsoak::recording
