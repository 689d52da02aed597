#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "cli/command.h"
#include "cli/help_page.h"
#include "derate/exporter.h"

namespace heatsoak::cli::commands {
namespace {

/// Returns all long names of an option; none of a word without option.
std::vector<std::string> long_names(const HelpOption& option) {
  std::vector<std::string> names;
  std::ranges::copy_if(option.names, std::back_inserter(names), [](const std::string& name) { return name.starts_with("--"); });
  return names;
}

bool has_name(const HelpOption& option, std::string_view name) { return std::ranges::find(option.names, name) != option.names.end(); }

/// Returns the kind of value of an option or of a word without option. The shell asks the program for the names each time the user
/// completes a word.
std::string_view kind_of(std::string_view verb, const HelpOption& option) {
  return has_name(option, "--motor") || has_name(option, "--motors") ? "motors"
         : has_name(option, "--robot")                               ? "robots"
         : has_name(option, "--duty")                                ? "duties"
         : verb == "describe" && long_names(option).empty()          ? "topics"
                                                                     : "";
}

/// Returns whether the option takes names separated by commas, or "all".
bool takes_list(const HelpOption& option) { return has_name(option, "--motors"); }

/// Returns the pages with the output formats of `derate`, which the help leaves to `list formats`.
std::vector<HelpPage> pages_with_formats(std::vector<HelpPage> pages) {
  for (HelpPage& page : pages) {
    for (HelpOption& option : page.options) {
      if (page.verb == "derate" && has_name(option, "--to")) {
        std::ranges::transform(derate::all_exporters(), std::back_inserter(option.choices),
                               [](const derate::ExporterType& each) { return std::string(each.name); });
      }
    }
  }
  return pages;
}

/// Returns the cases of the values that follow each of the words `before`.
std::string bash_values(std::string_view verb, const HelpOption& option, const std::vector<std::string>& before) {
  const std::string_view kind = kind_of(verb, option);
  if (option.choices.empty() && kind.empty()) {
    return "";
  }
  const std::string values = !option.choices.empty()
                                 ? fmt::format("words='{}'", fmt::join(option.choices, " "))
                                 : fmt::format("words=\"{}$(heatsoak list {} --quiet 2>/dev/null)\"{}", takes_list(option) ? "all " : "",
                                               kind, takes_list(option) ? " list=1" : "");
  std::string cases;
  for (const std::string& word : before) {
    cases += fmt::format("    {}:{}) {} ;;\n", verb, word, values);
  }
  return cases;
}

std::string bash_script(const std::vector<HelpPage>& pages) {
  std::vector<std::string> verbs;
  std::string cases;
  std::string values;
  for (const HelpPage& page : pages) {
    verbs.push_back(page.verb);
    std::vector<std::string> words;
    for (const HelpOption& option : page.options) {
      const std::vector<std::string> names = long_names(option);
      std::ranges::copy(names, std::back_inserter(words));
      values += bash_values(page.verb, option, names.empty() ? std::vector{page.verb} : names);
    }
    cases += fmt::format("    {}) words='{}' ;;\n", page.verb, fmt::join(words, " "));
  }
  return fmt::format(R"bash(# bash completion of heatsoak: source <(heatsoak completion)
_heatsoak() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words='{0}' list= before=
  # bash makes three words of --robot=x.
  if [ "$previous" = = ]; then previous=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  if [ "$current" = = ]; then current=; fi
  case ${{COMP_WORDS[1]}} in
{1}  esac
  if [ "$COMP_CWORD" -eq 1 ]; then words='{0}'; fi
  case ${{COMP_WORDS[1]}}:$previous in
{2}  esac
  # Of a list such as a,b the last name is completed.
  if [ -n "$list" ] && [[ $current == *,* ]]; then before=${{current%,*}},; fi
  COMPREPLY=($(compgen -P "$before" -W "$words" -- "${{current#"$before"}}"))
  if [ ${{#COMPREPLY[@]}} -eq 0 ]; then COMPREPLY=($(compgen -f -- "$current")); fi
}}
complete -F _heatsoak heatsoak
)bash",
                     fmt::join(verbs, " "), cases, values);
}

/// Quotes a text for single quotes and replaces characters that zsh's _arguments would interpret.
std::string zsh_quoted(std::string text) {
  for (const auto& [from, to] : {std::pair("'", "'\\''"), {"[", "("}, {"]", ")"}, {":", ","}}) {
    text = CLI::detail::find_and_replace(text, from, to);
  }
  return text;
}

std::string zsh_value(std::string_view verb, const HelpOption& option) {
  if (!option.takes_value) {
    return "";
  }
  const std::string_view kind = kind_of(verb, option);
  const std::string action = !option.choices.empty() ? fmt::format("({})", fmt::join(option.choices, " "))
                             : kind.empty()          ? "_files"
                                                     : fmt::format("{{_heatsoak_{} {}}}", takes_list(option) ? "list" : "name", kind);
  return fmt::format(":value:{}", action);
}

std::string zsh_script(const std::vector<HelpPage>& pages) {
  std::string verbs;
  std::string cases;
  for (const HelpPage& page : pages) {
    verbs += fmt::format("    '{}:{}'\n", page.verb, zsh_quoted(page.summary));
    cases += fmt::format("    {}) _arguments", page.verb);
    for (const HelpOption& option : page.options) {
      const std::vector<std::string> names = long_names(option);
      // The list in parentheses excludes the other names once one of them is on the line.
      const std::string exclusive = names.size() > 1 ? fmt::format("({})", fmt::join(names, " ")) : "";
      for (const std::string& name : names) {
        cases += fmt::format(" \\\n      '{}{}{}[{}]{}'", exclusive, name, option.takes_value ? "=" : "", zsh_quoted(option.meaning),
                             zsh_value(page.verb, option));
      }
      if (names.empty() && (!option.choices.empty() || !kind_of(page.verb, option).empty())) {
        cases += fmt::format(" \\\n      '1{}'", zsh_value(page.verb, option));
      }
    }
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return fmt::format(R"zsh(#compdef heatsoak
# zsh completion of heatsoak: heatsoak completion zsh > ~/.zfunc/_heatsoak
# Names of a kind; files if none matches.
_heatsoak_name() {{
  local -a heatsoak_names=(${{(f)"$(heatsoak list $1 --quiet 2>/dev/null)"}})
  compadd -a heatsoak_names || _files
}}
# Names separated by commas, or all; files if none matches.
_heatsoak_list() {{
  local -a heatsoak_names=(all ${{(f)"$(heatsoak list $1 --quiet 2>/dev/null)"}})
  _values -s , name $heatsoak_names || _files
}}
_heatsoak() {{
  local -a verbs
  verbs=(
{}  )
  if (( CURRENT == 2 )); then
    _describe verb verbs
    return
  fi
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
  case $verb in
{}  esac
}}
if [ "$funcstack[1]" = _heatsoak ]; then _heatsoak "$@"; else compdef _heatsoak heatsoak; fi
)zsh",
                     verbs, cases);
}

std::string fish_quoted(const std::string& text) {
  return CLI::detail::find_and_replace(CLI::detail::find_and_replace(text, "\\", "\\\\"), "'", "\\'");
}

std::string fish_script(const std::vector<HelpPage>& pages) {
  std::string text = R"fish(# fish completion of heatsoak: heatsoak completion fish > ~/.config/fish/completions/heatsoak.fish
function __heatsoak_verb_is
    set -l words (commandline -opc)
    set -q words[2]; and test $words[2] = $argv[1]
end
# Names of the kind $argv[1] and further words, all after the text $argv[2]; files if none matches.
function __heatsoak_names
    set -l word (commandline -ct | string replace -r '^--[^=]*=' '')
    set -l names "$argv[2]"$argv[3..-1] "$argv[2]"(heatsoak list $argv[1] --quiet 2>/dev/null)
    set -l matches (string match -- "$word*" $names)
    if set -q matches[1]
        string join \n $matches
    else
        __fish_complete_path $word
    end
end
# Names separated by commas, or all.
function __heatsoak_list
    __heatsoak_names $argv[1] "$(commandline -ct | string replace -r '^--[^=]*=' '' | string replace -r '[^,]*$' '')" all
end
)fish";
  for (const HelpPage& page : pages) {
    text += fmt::format("complete -c heatsoak -n __fish_use_subcommand -f -a {} -d '{}'\n", page.verb, fish_quoted(page.summary));
    for (const HelpOption& option : page.options) {
      const std::string_view kind = kind_of(page.verb, option);
      const std::string values = !option.choices.empty() ? fmt::format(" -f -a '{}'", fmt::join(option.choices, " "))
                                 : kind.empty()          ? ""
                                                : fmt::format(" -f -a '(__heatsoak_{} {})'", takes_list(option) ? "list" : "names", kind);
      const std::vector<std::string> names = long_names(option);
      if (names.empty()) {
        text += values.empty() ? "" : fmt::format("complete -c heatsoak -n '__heatsoak_verb_is {}'{}\n", page.verb, values);
        continue;
      }
      std::string flags;
      for (const std::string& name : names) {
        flags += fmt::format(" -l {}", name.substr(2));
      }
      text += fmt::format("complete -c heatsoak -n '__heatsoak_verb_is {}'{} -d '{}'{}{}\n", page.verb, flags, fish_quoted(option.meaning),
                          option.takes_value ? " -r" : "", values);
    }
  }
  return text;
}

}  // namespace

Command completion() {
  return {.name = {},
          .summary = "Prints a completion script for bash, zsh or fish",
          .example = "source <(heatsoak completion bash)",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto shell = std::make_shared<std::string>("bash");
            app.add_option("shell", *shell, "shell that reads the script")->check(CLI::IsMember({"bash", "zsh", "fish"}));
            return [shell, &app, &session] {
              const std::vector<HelpPage> pages = pages_with_formats(help_pages(*app.get_parent()));
              session.say(*shell == "zsh" ? zsh_script(pages) : *shell == "fish" ? fish_script(pages) : bash_script(pages));
              return base::ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::cli::commands
