// The list of written files at the end of an answer.
#include "present/written_files.h"

#include <gmock/gmock.h>

namespace heatsoak::present {
namespace {

using Paths = std::vector<std::filesystem::path>;
using testing::ElementsAre;

TEST(WrittenFiles, are_listed_in_their_order) {
  EXPECT_THAT(names_of_written(Paths{"b.csv", "out/a.svg", "a.json"}, Paths{"out", ""}), ElementsAre("b.csv", "out/a.svg", "a.json"));
  EXPECT_THAT(names_of_written({}, {}), ElementsAre());
}

TEST(WrittenFiles, of_a_large_folder_are_counted) {
  Paths files{"first.csv"};
  for (int i = 0; i < 7; ++i) {
    files.push_back("out/core/" + std::to_string(i) + ".h");
  }
  files.emplace_back("./out/core_config.h");
  EXPECT_EQ(names_of_written(files, Paths{"out"}).size(), files.size()) << "eight files are still listed";
  files.emplace_back("out/../out/list.txt");
  files.emplace_back("outside/last.json");
  EXPECT_THAT(names_of_written(files, Paths{"out/"}), ElementsAre("first.csv", "out/ (9 files)", "outside/last.json"));
  EXPECT_THAT(names_of_written(files, {}), testing::SizeIs(files.size())) << "only folders that the command makes are counted";
}

}  // namespace
}  // namespace heatsoak::present
