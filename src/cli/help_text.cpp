#include "cli/help_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "present/wrap.h"

namespace heatsoak::cli {

HelpText::HelpText(std::size_t width) : width_(width) {
  label("SUBCOMMAND", "VERB");
  label("REQUIRED", "(required)");
}

std::string HelpText::beside_names(const std::string& text) const {
  constexpr std::size_t kLeast = 30;
  return present::wrapped(text, "", std::max(kLeast, width_ - std::min(width_, get_column_width())));
}

std::string HelpText::make_option_name(const CLI::Option* option, bool is_positional) const {
  // CLI11 appends the value of a flag that switches something off.
  std::string names = CLI::Formatter::make_option_name(option, is_positional);
  constexpr std::string_view kOff = "{false}";
  const std::size_t at = names.find(kOff);
  return at == std::string::npos ? names : names.erase(at, kOff.size());
}

std::string HelpText::make_option_opts(const CLI::Option* option) const {
  // CLI11 appends a check to the name of the type: "TEXT:{a,b}", "INT:INT in [1 - 1000]". The check alone says enough.
  std::string text = CLI::Formatter::make_option_opts(option);
  const std::string type = option->get_type_name();
  const std::size_t check = type.find(':');
  const std::size_t at = check == std::string::npos ? check : text.find(type);
  return at == std::string::npos ? text : text.erase(at, check + 1);
}

std::string HelpText::make_option_desc(const CLI::Option* option) const { return beside_names(option->get_description()); }

std::string HelpText::make_subcommand(const CLI::App* verb) const {
  std::ostringstream text;
  CLI::detail::format_help(text, verb->get_display_name(true), beside_names(verb->get_description()), get_column_width());
  return text.str();
}

std::string HelpText::make_description(const CLI::App* app) const { return present::wrapped(app->get_description(), "", width_) + "\n"; }

std::string folded_commands(std::string_view commands, std::size_t width) {
  constexpr std::string_view kIndent = "  ";
  constexpr std::string_view kContinued = "      ";
  constexpr std::string_view kFold = " \\";
  std::string text;
  std::istringstream lines{std::string(commands)};
  for (std::string command; std::getline(lines, command);) {
    std::istringstream words(command);
    std::string line;
    // An option stays with its value, and && begins a command.
    std::string unit;
    const auto put = [&] {
      const bool is_first = line.empty();
      if (!is_first && line.size() + 1 + unit.size() + kFold.size() > width) {
        text += fmt::format("{}{}\n", line, kFold);
        line = std::string(kContinued) + unit;
      } else {
        line += std::string(is_first ? kIndent : " ") + unit;
      }
      unit.clear();
    };
    for (std::string word; words >> word;) {
      const bool is_value = unit.starts_with("--") && unit.find(' ') == std::string::npos && !word.starts_with("--");
      if (!unit.empty() && !is_value) {
        put();
      }
      unit += (unit.empty() ? "" : " ") + word;
    }
    if (!unit.empty()) {
      put();
      text += line + "\n";
    }
  }
  return text;
}

}  // namespace heatsoak::cli
