#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <memory>

#include "cli/command.h"

namespace heatsoak::commands {
namespace {

/// Verbs and their options come from the parser itself; ids are asked of the program when a key is pressed.
std::string bash_script(const CLI::App& program) {
  std::vector<std::string> verbs;
  std::string cases;
  for (const CLI::App* verb : program.get_subcommands({})) {
    verbs.push_back(verb->get_name());
    std::vector<std::string> words;
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        words.push_back("--" + name);
      }
    }
    cases += fmt::format("    {}) words='{}' ;;\n", verb->get_name(), fmt::join(words, " "));
  }
  return fmt::format(R"bash(# bash completion of heatsoak: source <(heatsoak completion)
_heatsoak() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words='{0}'
  case ${{COMP_WORDS[1]}} in
{1}  esac
  if [ "$COMP_CWORD" -eq 1 ]; then words='{0}'; fi
  case $previous in
    --motor|--motors) words="$(heatsoak list motors 2>/dev/null | cut -d' ' -f1)" ;;
    --robot) words="$(heatsoak list robots 2>/dev/null | cut -d' ' -f1)" ;;
    --duty) words="$(heatsoak list duties 2>/dev/null | cut -d' ' -f1)" ;;
    list) words='motors robots duties effects formats' ;;
    describe) words="$(for kind in motors robots duties effects; do heatsoak list $kind 2>/dev/null; done | cut -d' ' -f1)" ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  if [ ${{#COMPREPLY[@]}} -eq 0 ]; then COMPREPLY=($(compgen -f -- "$current")); fi
}}
complete -F _heatsoak heatsoak
)bash",
                     fmt::join(verbs, " "), cases);
}

}  // namespace

Command completion() {
  return {.name = {},
          .summary = "Prints a completion script for bash (and for zsh after `autoload bashcompinit; bashcompinit`)",
          .example = "source <(heatsoak completion)",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            return [&app, &session] {
              session.say(bash_script(*app.get_parent()));
              return ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::commands
