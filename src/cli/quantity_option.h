// Options with a quantity: "6A", "4 s", "25degC", or a number in the unit that the help names.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "base/parameter.h"

namespace heatsoak::cli {

/// `value` holds the default and is set in the unit of `spec`. A wrong unit or range is a usage error.
CLI::Option* add_quantity(CLI::App& app, const std::string& flag, double& value, const base::ParameterSpec& spec);
/// Adds an option without a default of its own, because the default depends on other inputs.
CLI::Option* add_quantity(CLI::App& app, const std::string& flag, std::optional<double>& value, const base::ParameterSpec& spec);

/// Returns a check for an integer from 0 to `most`. It replaces CLI11's parsing, which reads -1 as 2^64 − 1, clips too large numbers and
/// reads 010 as 8.
std::function<std::string(const std::string&)> whole_number(std::uint64_t most);

/// Adds --seed, a non-negative integer; `seed` holds the default.
CLI::Option* add_seed(CLI::App& app, std::uint64_t& seed, const std::string& meaning);

/// Adds --plot with FILE.svg or FILE.png; another extension is a usage error.
CLI::Option* add_picture(CLI::App& app, std::string& file, const std::string& meaning);

inline constexpr std::string_view kTableEnding = ".csv";

/// Adds --out FILE.csv; another extension is a usage error.
CLI::Option* add_table(CLI::App& app, std::string& file, const std::string& meaning);

}  // namespace heatsoak::cli
