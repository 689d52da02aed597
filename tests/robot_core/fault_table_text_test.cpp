// The fault table in robot_core/reason.h, the enumeration below it, and the tests name the same faults.
#include <gtest/gtest.h>

#include "fault_table_rows.h"

namespace heatsoak::test_robot {
namespace {

std::map<int, std::string> enum_members() {
  std::map<int, std::string> members;
  const std::string text = text_of("robot_core/reason.h");
  const std::regex member(R"(\n  (\w+) = (\d+),)");
  for (std::sregex_iterator at(text.begin(), text.end(), member), end; at != end; ++at) {
    members[std::stoi((*at)[2])] = (*at)[1];
  }
  return members;
}

TEST(FaultTableText, AndEnumAgree) {
  const std::map<int, char> rows = table_rows();
  const std::map<int, std::string> members = enum_members();
  const std::string tests = text_of("tests/robot_core/fault_table_test.cpp") + text_of("tests/robot_core/fault_table_wheels_test.cpp");
  ASSERT_GE(members.size(), 10U);
  for (const auto& [code, name] : members) {
    EXPECT_EQ(rows.count(code), code >= 100 ? 1U : 0U) << name;
    if (code >= 100) {
      EXPECT_NE(tests.find("TEST(FaultTable, " + name + ")"), std::string::npos) << name << " has no test";
    }
  }
  for (const auto& [code, letter] : rows) {
    EXPECT_EQ(members.count(code), 1U) << code;
    EXPECT_TRUE(letter == 'W' || letter == 'R') << code;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
