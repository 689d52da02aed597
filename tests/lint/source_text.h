// The files of the tree, as far as the house rules look at them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::lint {

struct SourceFile {
  std::string path;  ///< from the tree's root, "src/base/figure.h"
  std::string text;
};

/// Every text file under `folder` of the tree (all of it where empty), sorted; not what is built or fetched.
std::vector<SourceFile> files_in(const std::filesystem::path& folder);

/// C++ with comments, texts and preprocessor lines blanked out; lines keep their numbers.
std::string code_only(std::string_view text);

struct Token {
  std::string text;
  int line = 0;
};
/// Identifiers, numbers, "::", and single characters of the rest.
std::vector<Token> tokens(std::string_view code);

struct Include {
  std::string path;
  bool quoted = false;
  int line = 0;
};
std::vector<Include> includes(std::string_view text);

}  // namespace heatsoak::lint
