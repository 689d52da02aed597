// Every reason of the drive core has its own name in JSON.
#include "simulate/reason_name.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "support/source_folder.h"

namespace heatsoak::simulate {
namespace {

TEST(ReasonName, IsThatOfTheEnumerator) {
  std::ifstream stream(kSource / "robot_core/reason.h");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  text = text.substr(text.find("enum class Reason"));
  const std::regex enumerator(R"(\n  (\w+) = (\d+),)");
  int count = 0;
  for (std::sregex_iterator each(text.begin(), text.end(), enumerator), end; each != end; ++each, ++count) {
    EXPECT_EQ(to_string(static_cast<robot_core::Reason>(std::stoi((*each)[2]))), (*each)[1].str());
  }
  EXPECT_GE(count, 30);
}

}  // namespace
}  // namespace heatsoak::simulate
