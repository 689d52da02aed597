#include "check/command_answers.h"

#include <fmt/format.h>

#include <utility>

#include "check/check_file.h"

namespace heatsoak::check {
namespace {

std::string key_of(const Check& check) { return fmt::format("{}\n{}", check.folder.string(), check.command); }

}  // namespace

CommandWords command_words(std::string_view text) {
  CommandWords all;
  std::optional<std::string> word;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      if (word) {
        all.words.push_back(*std::exchange(word, std::nullopt));
      }
    } else if (c == '"' || c == '\'') {
      const std::size_t end = text.find(c, i + 1);
      if (end == std::string_view::npos) {
        return {{}, fmt::format("{} opens a word that is not closed; expected another {}", c, c)};
      }
      word = word.value_or("") + std::string(text.substr(i + 1, end - i - 1));
      i = end;
    } else {
      word = word.value_or("") + c;
    }
  }
  if (word) {
    all.words.push_back(*word);
  }
  if (!all.words.empty() && all.words.front() == "heatsoak") {
    all.words.erase(all.words.begin());
  }
  if (all.words.empty() || all.words.front() == "check" || all.words.front().starts_with('-')) {
    all.problem = "expected a command with a JSON answer and its options, such as \"derate --robot R --motor M\", but not check";
  }
  for (const std::string& each : all.words) {
    // Their result is an exit code, which limits on numbers would not see.
    for (const std::string_view gate : {"--check", "--fail-on"}) {
      if (each == gate || each.starts_with(std::string(gate) + "=")) {
        all.problem =
            fmt::format("{} has no place in a check; expected limits on the numbers of the command's answer, or table = \"FILE\"", gate);
      }
    }
  }
  return all;
}

bool inputs_are_valid(const CheckInputs& check_inputs, const std::vector<std::string>& words, const std::filesystem::path& folder) {
  try {
    check_inputs(words, folder);
    return true;
  } catch (const base::Failure& failure) {
    std::vector<base::Diagnostic> all(failure.diagnostics().begin(), failure.diagnostics().end());
    for (base::Diagnostic& each : all) {
      each.at.file = each.at.file.empty() ? "" : (folder / each.at.file).lexically_normal().string();
    }
    throw base::Failure(failure.code(), failure.message(), std::move(all));
  }
}

void CommandAnswers::run(std::span<const Check> checks) {
  for (const Check& check : checks) {
    if (check.command.empty()) {
      continue;
    }
    const auto [place, is_new] = kept_.try_emplace(key_of(check));
    if (!is_new) {
      continue;
    }
    try {
      if (!run_) {
        throw base::Failure(base::ExitCode::bug, "commands cannot be run here");
      }
      place->second.answer = run_(command_words(check.command).words, check.folder);
    } catch (const base::Failure& failure) {
      place->second.failure.emplace(failure);
    }
  }
}

const nlohmann::ordered_json& CommandAnswers::of(const Check& check) const {
  const Kept& kept = kept_.at(key_of(check));
  if (kept.failure) {
    throw base::Failure(*kept.failure);
  }
  return kept.answer;
}

}  // namespace heatsoak::check
