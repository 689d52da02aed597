// What is wrong with a command line, all of it at once: CLI11 stops at the first mistake.
#pragma once

#include <CLI/Error.hpp>
#include <span>
#include <string>

#include "cli/command.h"

namespace heatsoak {

/// Throws Failure (bad_input): no such verb, or no such options; with "did you mean". `words` are those after the program's name.
void check_words(const CLI::App& app, std::span<const char* const> words);

/// What parsing found, and which other options have a wrong value or are missing; a line each. `error` came out of parsing
/// `words` with `app`.
std::string all_mistakes(const CLI::ParseError& error, const CLI::App& app, std::span<const char* const> words);

}  // namespace heatsoak
