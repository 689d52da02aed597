// What `describe` shows of a robot file.
#include <gmock/gmock.h>

#include <regex>

#include "base/files.h"
#include "present/description.h"
#include "support/source_folder.h"

namespace heatsoak::present {
namespace {

TEST(RobotDescription, ListsSlipFactorsWithTheirOrigin) {
  const std::string text = base::read_file(kSource / "robot_core/robots/roboteam_twente_v2024.toml", 1'000'000);
  const robot::Robot robot = robot::parse_robot(
      std::regex_replace(text, std::regex("\n\\[wheels\\]\n"),
                         "\n[wheels]\nslip_factors = { value = [\"1.01\", \"1.02\", \"1.03\", \"1.04\"], origin = \"measured\", "
                         "source = \"drive of May\" }\n"),
      "robot.toml");
  std::vector<std::string> keys;
  for (const Table& table : robot_description(robot).tables) {
    for (const std::vector<Text>& row : table.rows) {
      keys.push_back(row.front().words);
    }
  }
  EXPECT_THAT(keys, testing::IsSupersetOf({"wheels.slip_factors[0]", "wheels.slip_factors[3]"}));
}

}  // namespace
}  // namespace heatsoak::present
