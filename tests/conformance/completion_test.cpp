// Completion in bash, zsh and fish, asked from the shells themselves.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "program_run.h"
#include "short_runs.h"
#include "support/skip_reasons.h"

namespace heatsoak {
namespace {

using testing::Contains;
using testing::UnorderedElementsAre;

/// Runs in an interactive zsh: loads the completion from $FOLDER and prints all matches between two marks.
constexpr const char* kInnerZsh = R"zsh(PROMPT= RPROMPT=
fpath=($FOLDER $fpath)
autoload -Uz compinit; compinit -u -D
bindkey '^I' complete-word
begin_list () { print '<begin>' }
end_list () { print '<end>'; exit }
compprefuncs=(begin_list)
comppostfuncs=(end_list)
compadd () {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
  local -a hits
  builtin compadd -A hits "$@"
  builtin compadd "$@"
  local code=$?
  (( $#hits )) && print -l -- $hits
  return $code
}
print '<''ready>'
)zsh";

/// Types $2 and a tab into an interactive zsh that has sourced the script above, and prints the matches.
constexpr const char* kOuterZsh = R"zsh(zmodload zsh/zpty
zpty z "FOLDER=$1 zsh -f -i"
zpty -w z "source $1/inner.zsh"
while zpty -r z reply && [[ $reply != *'<ready>'* ]]; do :; done
zpty -w -n z "$2"$'\t'
begun=0
while zpty -r z reply; do
  reply=${reply%%$'\r\n'}
  [[ $reply == *'<end>'* ]] && break
  (( begun )) && print -r -- $reply
  [[ $reply == *'<begin>'* ]] && begun=1
done
)zsh";

/// The words of a line as bash gives them to a completion: "=" is a word of its own.
constexpr const char* kBash = R"bash(line=${2//=/ = }
read -ra COMP_WORDS <<< "$line"
[[ $line == *' ' ]] && COMP_WORDS+=('')
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
source "$1/heatsoak.bash"
_heatsoak
printf '%s\n' "${COMPREPLY[@]}"
)bash";

class Completion : public testing::TestWithParam<const char*> {
 protected:
  Completion() {
    options_.folder = folder_.path();
    write(folder_.path() / "my_robot.toml", "");
    write(folder_.path() / "inner.zsh", kInnerZsh);
    write(folder_.path() / "outer.zsh", kOuterZsh);
    write(folder_.path() / "lines.bash", kBash);
    EXPECT_EQ(run_line("heatsoak completion bash > heatsoak.bash && heatsoak completion zsh > _heatsoak && heatsoak completion fish > "
                       "heatsoak.fish",
                       options_)
                  .exit_code,
              0);
  }

  void SetUp() override {
    if (run_line(fmt::format("command -v {}", GetParam())).exit_code != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI << GetParam() << " is not installed, so its completion is not tested";
    }
  }

  /// Returns the offered words for the end of a line, without the part of the word before "=" or a comma.
  std::set<std::string> completed(const std::string& line) {
    const std::string shell = GetParam();
    const std::string folder = folder_.path().string();
    const ProgramRun offered =
        run_line(shell == "bash"  ? fmt::format("bash lines.bash '{}' '{}'", folder, line)
                 : shell == "zsh" ? fmt::format("zsh -f outer.zsh '{}' '{}'", folder, line)
                                  : fmt::format("fish --no-config -c \"source heatsoak.fish; complete -C'{}'\"", line),
                 options_);
    EXPECT_EQ(offered.err, "") << shell << ": " << line;
    std::set<std::string> words;
    std::istringstream lines(offered.out);
    for (std::string word; std::getline(lines, word);) {
      word = word.substr(0, word.find('\t'));
      word = word.substr(word.find_last_of("=,") + 1);
      if (!word.empty()) {
        words.insert(word);
      }
    }
    return words;
  }

  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_P(Completion, offers_every_verb) {
  EXPECT_EQ(completed("heatsoak eval"), std::set<std::string>{"evaluate"});
  for (const std::string& verb : verb_names()) {
    EXPECT_THAT(completed("heatsoak " + verb), Contains(verb));
  }
}

TEST_P(Completion, offers_options_and_their_words) {
  EXPECT_THAT(completed("heatsoak evaluate --mo"), UnorderedElementsAre("--model", "--motor", "--motors"));
  EXPECT_THAT(completed("heatsoak duty --planner "), UnorderedElementsAre("bang_bang", "jerk_limited"));
  EXPECT_THAT(completed("heatsoak derate --to c_h"), UnorderedElementsAre("c_header", "c_header_q15"));
  EXPECT_THAT(completed("heatsoak generate c"), UnorderedElementsAre("core"));
  EXPECT_THAT(completed("heatsoak log "), UnorderedElementsAre("inspect", "convert"));
  EXPECT_THAT(completed("heatsoak generate core --ro"), UnorderedElementsAre("--robot"));
  EXPECT_THAT(completed("heatsoak describe check --js"), UnorderedElementsAre("--json")) << "a verb may be a word of another verb";
}

TEST_P(Completion, offers_names_of_the_data) {
  EXPECT_THAT(completed("heatsoak evaluate --robot "),
              UnorderedElementsAre("roboteam_twente_v2024", "roboteam_twente_v2025", "tigers_v2020"));
  EXPECT_THAT(completed("heatsoak evaluate --robot=ti"), UnorderedElementsAre("tigers_v2020"));
  EXPECT_THAT(completed("heatsoak describe iron"), UnorderedElementsAre("iron_loss_eddy", "iron_loss_hysteresis"));
  EXPECT_THAT(completed("heatsoak simulate --duty pap"), UnorderedElementsAre("paper_intermittent"));
}

TEST_P(Completion, offers_files_where_no_name_matches) {
  EXPECT_THAT(completed("heatsoak evaluate --robot my_"), UnorderedElementsAre("my_robot.toml"));
  EXPECT_THAT(completed("heatsoak lint my_"), UnorderedElementsAre("my_robot.toml"));
}

TEST_P(Completion, completes_the_last_name_of_a_list) {
  EXPECT_THAT(completed("heatsoak evaluate --motors al"), UnorderedElementsAre("all"));
  EXPECT_THAT(completed("heatsoak evaluate --motor al"), UnorderedElementsAre("all")) << "another name of --motors";
  EXPECT_THAT(completed("heatsoak evaluate --motor maxon_ecx_flat_32l_48v,nanotec_df45l024048"),
              UnorderedElementsAre("nanotec_df45l024048_a2"));
  EXPECT_THAT(completed("heatsoak evaluate --motors maxon_ecx_flat_32l_48v,nanotec_df45l024048"),
              UnorderedElementsAre("nanotec_df45l024048_a2"));
}

INSTANTIATE_TEST_SUITE_P(shells, Completion, testing::Values("bash", "zsh", "fish"), [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace heatsoak
