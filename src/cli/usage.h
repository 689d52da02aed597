// Reports all mistakes of a command line together; CLI11 stops at the first one.
#pragma once

#include <CLI/Error.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cli/command.h"

namespace heatsoak::cli {

/// Returns whether a word can be an output file: another option in its place cannot.
bool is_output(std::string_view word);

/// Throws Failure (bad_input) with "did you mean" for an unknown command or option. `words` follow the program's name.
void check_words(const CLI::App& app, std::span<const char* const> words);

/// Returns the error of parsing and all other options with a wrong value or without a required one, a line each. `error` is the result of
/// parsing `words` with `app`.
std::string all_mistakes(const CLI::ParseError& error, const CLI::App& app, std::span<const char* const> words);

}  // namespace heatsoak::cli
