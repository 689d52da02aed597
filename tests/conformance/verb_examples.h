// Examples of the verbs in the program's help, and the output that the table of verbs in README.md shows for them.
#pragma once

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {

inline std::string with_single_blanks(const std::string& text) { return std::regex_replace(text, std::regex("[ \n]+"), " "); }

/// Returns the lines below "Example:" in the help.
inline std::vector<std::string> examples_of_the_help(const std::string& verb) {
  std::istringstream help(run({verb, "--help"}).out);
  std::vector<std::string> result;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line.starts_with("Example")) {
      listed = true;
    } else if (listed && !result.empty() && result.back().ends_with('\\')) {
      result.back().back() = ' ';
      result.back() += line;
    } else if (listed && line.starts_with("  ")) {
      result.push_back(line.substr(2));
    }
  }
  return result;
}

/// A row of the table of verbs in README.md: a verb, and the line of output that the table shows for its first example.
struct VerbCell {
  std::string verb;
  std::string output;
};

inline std::vector<VerbCell> verb_cells() {
  const std::string text = content_of(kSource / "README.md");
  // The verb may have a word after it ("generate core").
  static const std::regex row("\n\\| `([a-z]+)[a-z ]*` \\| [^|]* \\| `([^`]*)` \\|");
  std::vector<VerbCell> cells;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), row); at != std::sregex_iterator(); ++at) {
    const std::string output = (*at)[2];
    cells.push_back({(*at)[1], output});
  }
  return cells;
}

}  // namespace heatsoak
