// The version differs between programs with other algorithms, and is the same for the same sources.
#include "base/version.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "base/files.h"
#include "support/skip_reasons.h"

namespace heatsoak::base {
namespace {

namespace fs = std::filesystem;

TEST(Version, HasAHashOfTheSources) {
  EXPECT_THAT(std::string(program_version()), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\\+[0-9a-f]{8}"));
}

TEST(Version, HashFollowsTheSources) {
  if (std::system("cmake --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no cmake here";
  }
  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("heatsoak_version_{}", static_cast<int>(getpid()));
  const auto hash_of = [&](const std::string& sub_folder, const std::string& text) {
    const fs::path root = folder / sub_folder;
    fs::create_directories(root);
    write_file(root / "a.cpp", text);
    write_file(root / "b.cpp", "same");
    const std::string command = fmt::format("cmake '-DFILES={0}/a.cpp|{0}/b.cpp' '-DROOT={0}' '-DOUT={0}/hash.h' -P '{1}'", root.string(),
                                            HEATSOAK_SOURCE_DIR "/cmake/source_hash_script.cmake");
    EXPECT_EQ(std::system(command.c_str()), 0);
    return read_file(root / "hash.h", 1000);
  };
  const std::string first = hash_of("one", "1");
  EXPECT_THAT(first, testing::MatchesRegex("#define HEATSOAK_SOURCE_HASH \"[0-9a-f]{8}\"\n"));
  EXPECT_EQ(hash_of("another", "1"), first) << "the folder of the project must not matter";
  EXPECT_NE(hash_of("another", "2"), first);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace heatsoak::base
