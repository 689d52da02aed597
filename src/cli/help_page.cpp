#include "cli/help_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>

#include "base/version.h"
#include "cli/command.h"

namespace heatsoak::cli {

std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) {
    return {};
  }
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

namespace {

HelpOption option_of(const CLI::Option& option) {
  HelpOption result;
  if (option.get_positional()) {
    result.names.push_back(option.get_name(true, false));
  }
  for (const std::string& name : option.get_snames()) {
    result.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    result.names.push_back("--" + name);
  }
  result.takes_value = option.get_expected_max() > 0 && option.get_type_size() > 0;
  if (result.takes_value) {
    result.value = option.get_type_name();
    result.choices = choices_of(result.value);
    // CLI11 appends a check to the name of the type: "G:{off,shadow}", "INT:INT in [1 - 1000]".
    result.value = result.value.substr(0, result.value.find(':'));
    result.value += option.get_default_str().empty() ? "" : "=" + option.get_default_str();
    const bool is_list = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    result.value += is_list && !result.value.ends_with("...") ? " ..." : "";
  }
  result.meaning = option.get_description();
  result.is_required = option.get_required();
  return result;
}

std::string written(const HelpOption& option) {
  const std::string names = fmt::format("{}", fmt::join(option.names, ", "));
  return option.value.empty() ? names : names + " " + option.value;
}

std::string meaning_of(const HelpOption& option) {
  std::string text = option.meaning;
  if (!option.choices.empty()) {
    text += fmt::format(" (one of {})", fmt::join(option.choices, ", "));
  }
  return option.is_required ? text + " (required)" : text;
}

std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c == '|' ? "\\|" : c == '<' ? "&lt;" : std::string(1, c);
  }
  return result;
}

/// Escapes text for roff: backslashes, hyphens, and a leading character that would start a command.
std::string roff(std::string_view text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) {
      result += "\\&";
    }
    result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    begins_line = c == '\n';
  }
  return result;
}

std::string man_head(std::string_view name) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH \"{}\" 1 \"\" \"heatsoak {}\" \"User Commands\"\n.SH NAME\n", roff(upper), base::program_version());
}

constexpr std::string_view kExitCodes =
    ".SH EXIT STATUS\n0 done and within limits, 1 a limit is exceeded, 2 bad input or usage, 3 the data cannot answer the question, 4 the "
    "numerics failed, 70 a bug.\n";

}  // namespace

std::vector<HelpPage> help_pages(const CLI::App& program) {
  std::vector<HelpPage> pages;
  const std::vector<Command> commands = all_commands();
  for (const CLI::App* verb : program.get_subcommands({})) {
    HelpPage page{.verb = verb->get_name(), .summary = verb->get_description(), .options = {}, .examples = {}};
    for (const CLI::Option* option : verb->get_options()) {
      page.options.push_back(option_of(*option));
    }
    std::ranges::stable_partition(page.options, [](const HelpOption& each) { return !each.names.front().starts_with('-'); });
    const auto command = std::ranges::find(commands, page.verb, &Command::name);
    for (const std::string& line : CLI::detail::split(std::string(command->example), '\n')) {
      page.examples.push_back(CLI::detail::trim_copy(line));
    }
    pages.push_back(std::move(page));
  }
  std::ranges::sort(pages, {}, &HelpPage::verb);
  return pages;
}

std::string markdown_of(const HelpPage& page) {
  std::string text = fmt::format("# heatsoak {}\n\n{}.\n\n| option | meaning |\n|---|---|\n", page.verb, page.summary);
  for (const HelpOption& option : page.options) {
    text += fmt::format("| `{}` | {} |\n", cell(written(option)), cell(meaning_of(option)));
  }
  text += fmt::format("\n```sh\n{}\n```\n", fmt::join(page.examples, "\n"));
  return text;
}

std::string markdown_index(const std::vector<HelpPage>& pages) {
  std::string text =
      "# Reference\n\nGenerated from the help of the program; `heatsoak VERB --help` shows the same.\n\n| verb | does |\n|---|---|\n";
  for (const HelpPage& page : pages) {
    text += fmt::format("| [`{0}`]({0}.md) | {1} |\n", page.verb, cell(page.summary));
  }
  return text;
}

std::string man_page_of(const HelpPage& page) {
  std::string text = man_head("heatsoak-" + page.verb);
  text +=
      fmt::format("heatsoak\\-{} \\- {}\n.SH SYNOPSIS\n.B heatsoak {}\n[OPTIONS]\n.SH OPTIONS\n", page.verb, roff(page.summary), page.verb);
  for (const HelpOption& option : page.options) {
    text += fmt::format(".TP\n.B {}\n{}\n", roff(written(option)), roff(meaning_of(option)));
  }
  text += ".SH EXAMPLES\n.nf\n";
  for (const std::string& example : page.examples) {
    text += roff(example) + "\n";
  }
  return text + ".fi\n" + std::string(kExitCodes) + ".SH SEE ALSO\n.BR heatsoak (1)\n";
}

std::string man_page_index(const std::vector<HelpPage>& pages) {
  std::string text = man_head("heatsoak") +
                     "heatsoak \\- does this motor survive the match, and if not, what current may the firmware still allow?\n"
                     ".SH SYNOPSIS\n.B heatsoak\nVERB [OPTIONS]\n.SH VERBS\n";
  for (const HelpPage& page : pages) {
    text += fmt::format(".TP\n.BR heatsoak\\-{} (1)\n{}\n", page.verb, roff(page.summary));
  }
  return text + std::string(kExitCodes);
}

}  // namespace heatsoak::cli
