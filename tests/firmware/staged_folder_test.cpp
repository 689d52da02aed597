// A folder that is generated again beside files of its user.
#include "firmware/staged_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace heatsoak::firmware {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class GeneratedAgain : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    fs::create_directories(root_);
    generate("first");
  }
  void TearDown() override { fs::remove_all(root_); }

  void generate(const std::string& source) const {
    const std::vector<CoreFile> files{{"core.c", source},
                                      {"Makefile", "core.o: core.c\n\tcp core.c core.o\n"},
                                      {kGeneratedFiles, std::string("core.c\nMakefile\n") + kGeneratedFiles + "\n"}};
    StagedFolder folder(core_, files, true);
    folder.commit();
  }
  [[nodiscard]] int make() const { return std::system(("make --silent -C '" + core_.string() + "'").c_str()); }

  const fs::path root_ = fs::path(testing::TempDir()) / ("staged_folder_" + std::to_string(getpid()));
  const fs::path core_ = root_ / "core";
};

/// The object of the first core stays in the folder. `make` must see that its source is newer.
TEST_F(GeneratedAgain, IsCompiledAgain) {
  ASSERT_EQ(make(), 0);
  ASSERT_EQ(content_of(core_ / "core.o"), "first");
  generate("second");
  ASSERT_EQ(content_of(core_ / "core.o"), "first");
  ASSERT_EQ(make(), 0);
  EXPECT_EQ(content_of(core_ / "core.o"), "second");
}

TEST_F(GeneratedAgain, KeepsTheTimesOfAUsersFiles) {
  fs::create_directories(core_ / "firmware");
  const fs::path mine = core_ / "firmware/board.c";
  std::ofstream(mine) << "of my board";
  const fs::file_time_type old = fs::file_time_type::clock::now() - std::chrono::hours(5);
  fs::last_write_time(mine, old);
  const fs::file_time_type before = fs::last_write_time(mine);
  generate("second");
  EXPECT_EQ(content_of(mine), "of my board");
  EXPECT_EQ(fs::last_write_time(mine), before);
  EXPECT_GT(fs::last_write_time(core_ / "core.c"), before);
}

}  // namespace
}  // namespace heatsoak::firmware
