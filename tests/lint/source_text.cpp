#include "source_text.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace heatsoak::lint {
namespace fs = std::filesystem;
namespace {

const fs::path kRoot = HEATSOAK_SOURCE_DIR;

/// True for folders in .gitignore and hidden folders of other tools.
bool is_skipped(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name == "build" || name.starts_with("build-") || name == "out" || (name.starts_with('.') && name != ".ci");
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Returns the position after the closing quote of the text that starts at the quote `begin`.
std::size_t end_of_text(std::string_view text, std::size_t begin) {
  if (text[begin] == '"' && begin > 0 && text[begin - 1] == 'R') {
    const std::size_t open = text.find('(', begin);
    const std::string close = ")" + std::string(text.substr(begin + 1, open - begin - 1)) + "\"";
    const std::size_t found = text.find(close, open);
    return found == std::string_view::npos ? text.size() : found + close.size();
  }
  std::size_t at = begin + 1;
  while (at < text.size() && text[at] != text[begin]) {
    at += text[at] == '\\' ? 2 : 1;
  }
  return std::min(at + 1, text.size());
}

std::size_t end_of_directive(std::string_view text, std::size_t at) {
  while (at < text.size() && (text[at] != '\n' || text[at - 1] == '\\')) {
    ++at;
  }
  return at;
}

}  // namespace

std::vector<SourceFile> files_in(const fs::path& folder) {
  std::vector<SourceFile> files;
  for (fs::recursive_directory_iterator each(folder.empty() ? kRoot : kRoot / folder), end; each != end; ++each) {
    if (each->is_directory() && is_skipped(each->path())) {
      each.disable_recursion_pending();
    } else if (each->is_regular_file() && each->path().filename() != ".git") {  // .git is a file in a worktree
      std::ifstream stream(each->path(), std::ios::binary);
      std::string text{std::istreambuf_iterator<char>(stream), {}};
      if (text.find('\0') == std::string::npos) {
        files.push_back({each->path().lexically_relative(kRoot).generic_string(), std::move(text)});
      }
    }
  }
  std::ranges::sort(files, {}, &SourceFile::path);
  return files;
}

std::string code_only(std::string_view text) {
  std::string code(text);
  const auto blank = [&code](std::size_t begin, std::size_t end) {
    std::replace_if(
        code.begin() + static_cast<std::ptrdiff_t>(begin), code.begin() + static_cast<std::ptrdiff_t>(end),
        [](char c) { return c != '\n'; }, ' ');
  };
  bool line_is_empty = true;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (text.substr(at, 2) == "//") {
      end = std::min(text.find('\n', at), text.size());
      blank(at, end);
    } else if (text.substr(at, 2) == "/*") {
      end = std::min(text.find("*/", at + 2), text.size() - 2) + 2;
      blank(at, end);
    } else if (text[at] == '#' && line_is_empty) {
      end = end_of_directive(text, at);
      blank(at, end);
    } else if (text[at] == '"' || (text[at] == '\'' && (at == 0 || !is_name(text[at - 1])))) {
      end = end_of_text(text, at);
      blank(at, end);
    }
    line_is_empty = text[at] == '\n' || (line_is_empty && std::isspace(static_cast<unsigned char>(text[at])) != 0);
    at = end;
  }
  return code;
}

std::vector<Token> tokens(std::string_view code) {
  std::vector<Token> found;
  int line = 1;
  for (std::size_t at = 0; at < code.size();) {
    std::size_t end = at + 1;
    if (code[at] == '\n') {
      ++line;
    } else if (is_name(code[at])) {
      end = static_cast<std::size_t>(std::find_if_not(code.begin() + static_cast<std::ptrdiff_t>(at), code.end(), is_name) - code.begin());
      found.push_back({std::string(code.substr(at, end - at)), line});
    } else if (code.substr(at, 2) == "::") {
      end = at + 2;
      found.push_back({"::", line});
    } else if (std::isspace(static_cast<unsigned char>(code[at])) == 0) {
      found.push_back({std::string(1, code[at]), line});
    }
    at = end;
  }
  return found;
}

std::vector<Include> includes(std::string_view text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  std::istringstream stream{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (std::smatch match; std::regex_search(line, match, kInclude)) {
      found.push_back({match[2], match[1] == "\"", number});
    }
  }
  return found;
}

}  // namespace heatsoak::lint
