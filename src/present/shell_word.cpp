#include "present/shell_word.h"

#include <string_view>

namespace heatsoak::present {

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  if (word.find_first_not_of(kPlain) == std::string::npos) {
    return word;
  }
  std::string result = "'";
  for (const char each : word) {
    result += each == '\'' ? "'\\''" : std::string(1, each);
  }
  return result + "'";
}

}  // namespace heatsoak::present
