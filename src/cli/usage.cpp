#include "cli/usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <tuple>

#include "cli/help_page.h"
#include "input/data_folders.h"

namespace heatsoak::cli {

bool is_output(std::string_view word) { return word == "-" || !word.starts_with('-'); }

namespace {

/// "-3A" is a value, and "-" is an output.
bool is_option(std::string_view word) { return word.size() > 1 && word[0] == '-' && (word[1] == '-' || std::isalpha(word[1]) != 0); }

/// An option with the words up to the next option; the first group holds the words before all options.
using Group = std::vector<std::string>;

std::vector<Group> groups_of(std::span<const char* const> words) {
  std::vector<Group> groups(1);
  for (const char* word : words) {
    if (is_option(word)) {
      groups.emplace_back();
    }
    groups.back().emplace_back(word);
  }
  return groups;
}

/// Returns the option's name, or for a word without option what it stands for: "FILE.toml".
std::string name_of(const CLI::Option& option) {
  const std::string type = option.get_type_name().substr(0, option.get_type_name().find(':'));
  return option.get_positional() && !type.empty() && type != "TEXT" ? type : option.get_name();
}

/// Returns what is missing and what it is for; empty if the option is given or not needed.
std::string missing_words(const CLI::Option& option) {
  if (!option.get_required() || option.count() > 0) {
    return "";
  }
  const std::vector<std::string> choices = choices_of(option.get_type_name());
  return fmt::format("{} is required: {}{}", name_of(option), option.get_description(),
                     choices.empty() ? "" : fmt::format("; expected one of {}", fmt::join(choices, ", ")));
}

/// Rewrites CLI11's complaint about a word that is none of a set: "kind: duty not in {motor,robot}".
std::string plain_words(const std::string& complaint) {
  constexpr std::string_view kNotIn = " not in {";
  const std::size_t colon = complaint.find(": ");
  const std::size_t set = complaint.rfind(kNotIn);
  if (colon == std::string::npos || set == std::string::npos || set < colon || !complaint.ends_with('}')) {
    return complaint;
  }
  const std::string given = complaint.substr(colon + 2, set - colon - 2);
  const std::size_t first = set + kNotIn.size();
  const std::vector<std::string> known = CLI::detail::split(complaint.substr(first, complaint.size() - first - 1), ',');
  return fmt::format("{}: '{}' is not known; expected {}{}", complaint.substr(0, colon), given, fmt::join(known, ", "),
                     base::did_you_mean(given, known));
}

/// Returns the error in the values of one group; empty if there is none. Missing options are reported elsewhere.
std::string complaint(const Command& command, Group group) {
  Session nobody;
  CLI::App app;
  const auto run = command.declare(app, nobody);  // keeps the variables alive that the options write to
  std::ranges::reverse(group);                    // CLI11 expects the words in reverse order
  try {
    app.parse(std::move(group));
  } catch (const CLI::ValidationError& error) {
    return plain_words(error.what());
  } catch (const CLI::ConversionError& error) {
    return error.what();
  } catch (const CLI::ParseError&) {
  }
  return {};
}

/// Returns the names in the value of an option. `evaluate` takes several motors, or all; a file whose name contains commas is one.
std::vector<std::string> names_in(const std::string& value) {
  std::error_code unreadable;
  if (value.empty() || value == "all") {
    return {};
  }
  return std::filesystem::exists(value, unreadable) ? std::vector{value} : CLI::detail::split(value, ',');
}

/// Returns a complaint about each motor, robot and duty that has no file, so that it is reported together with other mistakes.
std::vector<std::string> unknown_ids(const CLI::App& verb) {
  const auto value_of = [&verb](const char* name) {
    const CLI::Option* const option = verb.get_option_no_throw(name);
    return option && option->count() > 0 ? option->results().front() : std::string();
  };
  std::vector<std::string> complaints;
  try {
    const input::DataFolders folders = input::DataFolders::find(value_of("--db"));
    for (const auto& [option, kind, folder] :
         {std::tuple("--motor", "motor", folders.motors), std::tuple("--robot", "robot", folders.robots),
          std::tuple("--duty", "duty", folders.duties)}) {
      for (const std::string& name : names_in(value_of(option))) {
        try {
          input::file_of(folder, kind, name);
        } catch (const base::Failure& failure) {
          complaints.emplace_back(failure.what());
        }
      }
    }
  } catch (const base::Failure&) {
    // Without data folders no id is known; the other mistakes are reported first.
  }
  return complaints;
}

/// Returns the command that the words begin with; null if there is none.
const CLI::App* verb_of(const CLI::App& app, std::span<const char* const> words) {
  for (const CLI::App* each : app.get_subcommands({})) {
    if (!words.empty() && each->get_name() == words.front()) {
      return each;
    }
  }
  return nullptr;
}

/// Returns a complaint about each option whose value is missing because the next option follows. CLI11 would take that option as the value.
std::vector<std::string> options_without_value(const CLI::App& verb, std::span<const char* const> words) {
  std::vector<std::string> complaints;
  const auto option_of = [&verb](std::string_view word) {
    return word.starts_with("--") ? verb.get_option_no_throw(std::string(word.substr(0, word.find('=')))) : nullptr;
  };
  for (std::size_t i = 0; i + 1 < words.size() && std::string_view(words[i]) != "--"; ++i) {
    const std::string_view word = words[i];
    const CLI::Option* const option = option_of(word);
    const bool has_value = option == nullptr || word.find('=') != std::string_view::npos || option->get_items_expected_min() == 0;
    if (!has_value && option_of(words[i + 1]) != nullptr) {
      complaints.push_back(fmt::format("{} has no value; expected {} before {}", word, option->get_type_name(), words[i + 1]));
    }
  }
  return complaints;
}

bool takes_one_value(const CLI::Option& option) {
  return option.get_items_expected_max() == 1 && option.get_multi_option_policy() == CLI::MultiOptionPolicy::Throw;
}

}  // namespace

void check_words(const CLI::App& app, std::span<const char* const> words) {
  const CLI::App* verb = verb_of(app, words);
  if (!verb && !words.empty() && words.front()[0] != '-') {
    std::vector<std::string> verbs;
    for (const CLI::App* each : app.get_subcommands({})) {
      verbs.push_back(each->get_name());
    }
    throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no verb '{}'{} (`heatsoak --help` lists them)", words.front(),
                                                               base::did_you_mean(words.front(), verbs)));
  }
  if (words.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        "there is no verb; expected one, such as `heatsoak evaluate` (`heatsoak --help` lists them)");
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : (verb ? *verb : app).get_options()) {
    for (const std::string& name : option->get_lnames()) {
      known.push_back("--" + name);
    }
  }
  std::vector<std::string> unknown;
  std::map<std::string, int> given;
  std::string_view before = app.get_name();
  for (const std::string_view word : words) {
    const std::string name(word.substr(0, word.find('=')));
    if (word.empty() || word.size() == name.size() + 1) {
      unknown.push_back(fmt::format("the value of {} is empty; check whether a shell variable is unset", word.empty() ? before : name));
      continue;
    }
    before = word;
    if (name == "--") {
      break;
    }
    if (name.starts_with("--") && std::ranges::find(known, name) == known.end()) {
      unknown.push_back(fmt::format("there is no option {}{} (`{}{} --help` lists them)", name, base::did_you_mean(name, known),
                                    app.get_name(), verb ? fmt::format(" {}", verb->get_name()) : ""));
    } else if (name.starts_with("--") && verb && takes_one_value(*verb->get_option_no_throw(name)) && ++given[name] == 2) {
      unknown.push_back(fmt::format("{} is given more than once; expected one value: remove the others", name));
    }
  }
  if (verb) {
    std::ranges::move(options_without_value(*verb, words), std::back_inserter(unknown));
  }
  if (!unknown.empty()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("{}", fmt::join(unknown, "\n")));
  }
}

std::string all_mistakes(const CLI::ParseError& error, const CLI::App& app, std::span<const char* const> words) {
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  std::vector<std::string> all{plain_words(error.what())};
  const CLI::App* verb = verb_of(app, words);
  // CLI11 checks values and missing options only after it has accepted all words; other errors are reported alone.
  const bool is_of_an_option =
      dynamic_cast<const CLI::ValidationError*>(&error) || dynamic_cast<const CLI::ConversionError*>(&error) || is_missing;
  if (!verb || !is_of_an_option) {
    return all.front();
  }
  if (is_missing) {
    all.clear();  // the loop over all options below has better words
  }
  const auto add = [&all](std::string mistake) {
    if (!mistake.empty() && std::ranges::find(all, mistake) == all.end()) {
      all.push_back(std::move(mistake));
    }
  };
  const std::vector<Command> commands = all_commands();
  const auto command = std::ranges::find(commands, verb->get_name(), &Command::name);
  for (const Group& group : groups_of(words.subspan(1))) {
    add(complaint(*command, group));
  }
  for (const CLI::Option* option : verb->get_options()) {
    add(missing_words(*option));
  }
  std::ranges::for_each(unknown_ids(*verb), add);
  return all.empty() ? error.what() : fmt::format("{}", fmt::join(all, "\n"));
}

}  // namespace heatsoak::cli
