// Command lines of the study programs.
#include "support/study_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace heatsoak {
namespace {

using testing::HasSubstr;

struct Ran {
  int exit_code = -1;
  bool has_begun = false;
  std::string out;
  std::string err;
};

/// A study with the words [FOLDER [CASES [MINUTES [fast|slow]]]].
Ran ran(std::vector<std::string> words) {
  words.insert(words.begin(), "heatsoak_study");
  std::vector<char*> argv;
  for (std::string& each : words) {
    argv.push_back(each.data());
  }
  Ran result;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  result.exit_code = run_study(static_cast<int>(argv.size()), argv.data(), "usage: heatsoak_study\n", 4, [&](const StudyWords& given) {
    static_cast<void>(given.whole(1, "CASES", 1, 300));
    static_cast<void>(given.positive(2, "MINUTES", 5.0));
    static_cast<void>(given.one_of(3, {"fast", "slow"}));
    result.has_begun = true;
    return given.required(0, "FOLDER") == "within" ? 0 : 1;
  });
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

TEST(StudyWords, HelpPrintsTheUsageAndRunsNothing) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{{"--help"}, {"-h"}, {"folder", "3", "--help"}}) {
    const Ran found = ran(words);
    EXPECT_EQ(found.exit_code, 0);
    EXPECT_EQ(found.out, "usage: heatsoak_study\n");
    EXPECT_FALSE(found.has_begun);
  }
}

TEST(StudyWords, WrongOnesAreNamedBeforeTheStudyBegins) {
  struct Wrong {
    std::vector<std::string> words;
    const char* message;
  };
  for (const auto& [words, message] :
       {Wrong{{"--fast"}, "there is no option --fast"}, Wrong{{"within", "3x"}, "CASES is '3x'; expected a whole number from 1 to"},
        Wrong{{"within", "0"}, "CASES is '0'"}, Wrong{{"within", "99999999999999999999"}, "CASES is"}, Wrong{{"within", ""}, "CASES is ''"},
        Wrong{{"within", "3", "inf"}, "MINUTES is 'inf'; expected a number above 0"}, Wrong{{"within", "3", "0"}, "MINUTES is '0'"},
        Wrong{{"within", "3", "1", "fsat"}, "'fsat' is not known; expected one of fast, slow"},
        Wrong{{"within", "3", "1", "fast", "more"}, "'more' is one word too many; expected at most 4"}}) {
    const Ran found = ran(words);
    EXPECT_EQ(found.exit_code, 2) << message;
    EXPECT_THAT(found.err, testing::AllOf(HasSubstr(message), HasSubstr("\nusage: heatsoak_study\n")));
    EXPECT_EQ(found.out, "");
    EXPECT_FALSE(found.has_begun) << message;
  }
  EXPECT_EQ(ran({}).exit_code, 2);
  EXPECT_THAT(ran({}).err, HasSubstr("FOLDER is missing"));
}

TEST(StudyWords, CorrectOnesReachTheStudy) {
  EXPECT_EQ(ran({"within"}).exit_code, 0);
  EXPECT_THAT(ran({"within"}).err, HasSubstr(base::program_version())) << "which program made the table";
  EXPECT_EQ(ran({"elsewhere", "3", "0.5", "slow"}).exit_code, 1) << "the study's own exit code";
  const StudyWords words({"folder", "12", "2.5", "slow"}, 4);
  EXPECT_EQ(words.whole(1, "CASES", 1, 300), 12U);
  EXPECT_EQ(words.positive(2, "MINUTES", 1.0), 2.5);
  EXPECT_EQ(words.one_of(3, {"fast", "slow"}), "slow");
  EXPECT_EQ(words.whole(4, "SEED", 0, 7), 7U) << "without the word";
}

TEST(StudyWords, FolderMustExist) {
  const StudyWords words({"/", "/no/such/folder"}, 2);
  EXPECT_EQ(words.folder(0, "."), "/");
  EXPECT_EQ(words.folder(2, "."), ".") << "without the word";
  EXPECT_THROW(static_cast<void>(words.folder(1, ".")), WrongWord);
}

TEST(StudyWords, OtherProblemsAreNoUsage) {
  testing::internal::CaptureStderr();
  std::string name = "heatsoak_study";
  char* argv[] = {name.data()};
  EXPECT_EQ(run_study(1, argv, "usage\n", 0, [](const StudyWords&) -> int { throw std::runtime_error("no disk"); }), 70);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "no disk\n");
}

}  // namespace
}  // namespace heatsoak
