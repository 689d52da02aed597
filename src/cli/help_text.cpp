#include "cli/help_text.h"

#include <algorithm>
#include <sstream>

#include "present/wrap.h"

namespace heatsoak::cli {

std::string HelpText::beside_names(const std::string& text) const {
  constexpr std::size_t kLeast = 30;
  return present::wrapped(text, "", std::max(kLeast, width_ - std::min(width_, get_column_width())));
}

std::string HelpText::make_option_desc(const CLI::Option* option) const { return beside_names(option->get_description()); }

std::string HelpText::make_subcommand(const CLI::App* verb) const {
  std::ostringstream text;
  CLI::detail::format_help(text, verb->get_display_name(true), beside_names(verb->get_description()), get_column_width());
  return text.str();
}

std::string HelpText::make_description(const CLI::App* app) const { return present::wrapped(app->get_description(), "", width_) + "\n"; }

}  // namespace heatsoak::cli
