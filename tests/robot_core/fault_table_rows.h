// Reads the fault table from the comment in robot_core/reason.h.
#pragma once

#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace heatsoak::test_robot {

inline std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(std::string(HEATSOAK_SOURCE_DIR) + "/" + path).rdbuf();
  return text.str();
}

/// Code and letter of each row of the table.
inline std::map<int, char> table_rows() {
  std::map<int, char> rows;
  const std::string text = text_of("robot_core/reason.h");
  const std::regex row(R"(// \| (\d+) ([A-Z]) +\|)");
  for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) {
    rows[std::stoi((*at)[1])] = (*at)[2].str().front();
  }
  return rows;
}

}  // namespace heatsoak::test_robot
