#include "base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "base/diagnostic.h"

namespace heatsoak::base {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  void SetUp() override { fs::create_directory(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      all.push_back(entry.path().filename().string());
    }
    return all;
  }
  fs::path folder_ = fs::temp_directory_path() / ("heatsoak_files_" + std::to_string(::getpid()));
};

constexpr std::size_t kMost_bytes = 100'000;

/// Starts a child process that writes ten times its limit to `file`, so that SIGXFSZ kills it while writing, and returns its status.
int status_of_writer_beyond_its_limit(const fs::path& file) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    const rlimit no_core{0, 0};
    const rlimit limit{kMost_bytes, kMost_bytes};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_DFL);
    write_file(file, std::string(10 * kMost_bytes, 'x'));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(writer, &status, 0);
  return status;
}

TEST_F(Files, a_writer_that_is_killed_leaves_nothing_behind) {
  const int status = status_of_writer_beyond_its_limit(folder_ / "answer.json");
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGXFSZ);
  EXPECT_THAT(names(), ElementsAre());
}

TEST_F(Files, a_writer_that_is_killed_leaves_what_was_there) {
  std::ofstream(folder_ / "answer.json") << "before";
  ASSERT_TRUE(WIFSIGNALED(status_of_writer_beyond_its_limit(folder_ / "answer.json")));
  EXPECT_THAT(names(), ElementsAre("answer.json"));
  EXPECT_EQ(read_file(folder_ / "answer.json", kMost_bytes), "before");
}

TEST_F(Files, a_new_one_keeps_to_the_umask) {
  const mode_t before = ::umask(027);
  write_file(folder_ / "answer.json", "now");
  ::umask(before);
  EXPECT_EQ(read_file(folder_ / "answer.json", kMost_bytes), "now");
  EXPECT_EQ(fs::status(folder_ / "answer.json").permissions(), fs::perms{0640});
  EXPECT_THAT(names(), ElementsAre("answer.json"));
}

TEST_F(Files, replaces_what_was_there_and_keeps_its_permissions) {
  for (const fs::perms permissions : {fs::perms{0600}, fs::perms{0666}, fs::perms{0755}}) {
    std::ofstream(folder_ / "answer.json") << "something longer than what comes now";
    fs::permissions(folder_ / "answer.json", permissions);
    const mode_t before = ::umask(027);
    write_file(folder_ / "answer.json", "now");
    ::umask(before);
    EXPECT_EQ(read_file(folder_ / "answer.json", kMost_bytes), "now");
    EXPECT_EQ(fs::status(folder_ / "answer.json").permissions(), permissions);
    EXPECT_THAT(names(), ElementsAre("answer.json"));
  }
}

TEST_F(Files, a_link_stays_a_link_to_a_file_with_its_permissions) {
  std::ofstream(folder_ / "private.json") << "before";
  fs::permissions(folder_ / "private.json", fs::perms{0600});
  fs::create_symlink("private.json", folder_ / "answer.json");
  write_file(folder_ / "answer.json", "now");
  EXPECT_TRUE(fs::is_symlink(folder_ / "answer.json"));
  EXPECT_EQ(read_file(folder_ / "private.json", kMost_bytes), "now");
  EXPECT_EQ(fs::status(folder_ / "private.json").permissions(), fs::perms{0600});
}

TEST_F(Files, a_link_to_a_file_that_does_not_exist_yet_stays_a_link) {
  fs::create_directory(folder_ / "runs");
  fs::create_symlink("runs/latest.json", folder_ / "near.json");
  fs::create_symlink(folder_ / "near.json", folder_ / "far.json");
  write_file(folder_ / "far.json", "now");
  EXPECT_TRUE(fs::is_symlink(folder_ / "far.json"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "near.json"));
  EXPECT_EQ(read_file(folder_ / "runs/latest.json", kMost_bytes), "now");
  fs::remove(folder_ / "runs/latest.json");
  EXPECT_TRUE(are_one_file(folder_ / "far.json", folder_ / "runs/latest.json"));
}

TEST_F(Files, a_link_into_a_missing_folder_or_to_itself_is_no_target) {
  fs::create_symlink("none/latest.json", folder_ / "lost.json");
  fs::create_symlink("circle.json", folder_ / "circle.json");
  for (const char* name : {"lost.json", "circle.json"}) {
    EXPECT_THROW(write_file(folder_ / name, "now"), Failure) << name;
    EXPECT_TRUE(fs::is_symlink(folder_ / name)) << name;
  }
  EXPECT_THAT(names(), testing::UnorderedElementsAre("circle.json", "lost.json"));
}

TEST_F(Files, of_which_one_cannot_be_written_all_stay_away) {
  const std::vector<OutputFile> files{{folder_ / "a", "1"}, {folder_ / "none" / "b", "2"}};
  try {
    write_files(files);
    FAIL() << "written";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("cannot be written: No such file or directory"));
  }
  EXPECT_THAT(names(), ElementsAre());
}

TEST_F(Files, a_stream_has_no_name_before_it_is_whole) {
  std::vector<std::unique_ptr<StreamedFile>> streams;
  streams.push_back(std::make_unique<StreamedFile>(folder_ / "rows.csv"));
  std::string all;
  for (int i = 0; i < 100'000; ++i) {
    all += std::to_string(i) + "\n";
    streams[0]->write(std::to_string(i) + "\n");
  }
  EXPECT_THAT(names(), ElementsAre());
  const std::vector<OutputFile> files{{folder_ / "rows.toml", "beside it"}};
  write_files(files, streams);
  EXPECT_EQ(read_file(folder_ / "rows.csv", all.size()), all);
  EXPECT_THAT(names(), testing::UnorderedElementsAre("rows.csv", "rows.toml"));
}

TEST_F(Files, a_stream_stays_away_with_what_cannot_be_written_beside_it) {
  std::vector<std::unique_ptr<StreamedFile>> streams;
  streams.push_back(std::make_unique<StreamedFile>(folder_ / "rows.csv"));
  streams[0]->write("row");
  const std::vector<OutputFile> nowhere{{folder_ / "none" / "b", "2"}};
  EXPECT_THROW(write_files(nowhere, streams), Failure);
  const std::vector<OutputFile> same{{folder_ / "rows.csv", "2"}};
  EXPECT_THROW(write_files(same, streams), Failure);
  streams.clear();
  EXPECT_THAT(names(), ElementsAre());
}

}  // namespace
}  // namespace heatsoak::base
