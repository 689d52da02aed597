// Files of the tree, as the house rules read them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::lint {

struct SourceFile {
  std::string path;  ///< path from the tree's root, for example "src/base/parameter_value.h"
  std::string text;
};

/// Returns every text file below `folder` (if empty, of the whole tree), sorted, without build and downloaded files.
std::vector<SourceFile> files_in(const std::filesystem::path& folder);

/// Returns C++ code with blanked comments, literals and preprocessor lines; line numbers stay unchanged.
std::string code_only(std::string_view text);

struct Token {
  std::string text;
  int line = 0;
};
/// Identifiers, numbers, "::", and all other characters one by one.
std::vector<Token> tokens(std::string_view code);

struct Include {
  std::string path;
  bool quoted = false;
  int line = 0;
};
std::vector<Include> includes(std::string_view text);

}  // namespace heatsoak::lint
