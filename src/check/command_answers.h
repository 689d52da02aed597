// Answers of this program's own commands, whose numbers a check can limit.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::check {

struct Check;

/// Runs a command in a folder, writes none of its files, and returns its JSON answer. Throws Failure like the command.
using RunCommand = std::function<nlohmann::ordered_json(const std::vector<std::string>& words, const std::filesystem::path& folder)>;

/// Parses a command and reads its inputs in a folder, but computes nothing. Throws Failure (bad_input) with all mistakes.
using CheckInputs = std::function<void(const std::vector<std::string>& words, const std::filesystem::path& folder)>;

struct CommandWords {
  std::vector<std::string> words;  ///< without "heatsoak"
  std::string problem;             ///< empty if the words are valid
};

/// Splits a command line at spaces. Text in single or double quotes is one word; there are no escapes.
CommandWords command_words(std::string_view text);

/// Returns true, or throws the mistakes that `check_inputs` finds, with paths that are valid in the working directory.
bool inputs_are_valid(const CheckInputs& check_inputs, const std::vector<std::string>& words, const std::filesystem::path& folder);

/// Answers of the commands of checks.
class CommandAnswers {
 public:
  explicit CommandAnswers(RunCommand run = {}) : run_(std::move(run)) {}

  /// Runs the commands of the checks one by one, because each uses all threads. A command that ran before in the same folder does not run
  /// again. A Failure is kept for of().
  void run(std::span<const Check> checks);
  /// Returns the answer of the check's command. Throws its Failure. Thread-safe.
  [[nodiscard]] const nlohmann::ordered_json& of(const Check& check) const;

 private:
  struct Kept {
    nlohmann::ordered_json answer;
    std::optional<base::Failure> failure = {};
  };
  RunCommand run_;
  std::map<std::string, Kept> kept_;
};

}  // namespace heatsoak::check
