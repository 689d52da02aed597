// Reads exported files back.
#pragma once

// Reads every exported file with a parser of its format and uses it like its consumer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "base/diagnostic.h"
#include "exported_motor.h"

namespace heatsoak::derate {

using testing::HasSubstr;

inline std::string refusal(std::string_view name, const Derating& derating) {
  try {
    static_cast<void>(exported(name, derating));
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    return failure.what();
  }
  return "accepted";
}

/// Returns "name value" of every line that is no comment.
inline std::map<std::string, std::string> lines_of(const std::string& text, const std::string& pattern) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    line = line.substr(0, line.find('#'));
    if (!line.empty()) {
      EXPECT_TRUE(std::regex_match(line, found, std::regex(pattern))) << line;
      values[found[1]] = found[2];
    }
  }
  return values;
}

}  // namespace heatsoak::derate
