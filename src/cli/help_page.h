// The help of a command as data, for man pages, the Markdown reference and completion scripts.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace heatsoak::cli {

struct HelpOption {
  std::vector<std::string> names;  ///< "-h", "--help"; one word without dashes for a positional
  std::string value;               ///< "FILE.toml", with "=" and the default if it has one; empty for a flag
  std::string meaning;
  bool is_required = false;
  bool takes_value = false;
  std::vector<std::string> choices;  ///< allowed values; empty if any value is allowed
};

struct HelpPage {
  std::string verb;
  std::string summary;
  std::vector<HelpOption> options;  ///< positionals first
  std::vector<std::string> examples;
};

/// Returns "a", "b" for a type name such as "G:{a,b}", the CLI11 notation of a set; nothing for another type name.
std::vector<std::string> choices_of(const std::string& type);

/// Returns the help pages of all commands, sorted by name.
std::vector<HelpPage> help_pages(const CLI::App& program);

std::string markdown_of(const HelpPage& page);
/// Returns the index of all pages with links.
std::string markdown_index(const std::vector<HelpPage>& pages);
/// Returns a page for man(1), section 1.
std::string man_page_of(const HelpPage& page);
std::string man_page_index(const std::vector<HelpPage>& pages);

}  // namespace heatsoak::cli
