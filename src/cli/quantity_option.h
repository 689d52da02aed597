// Options that take a quantity: "6A", "4 s", "25degC", or a bare number in the unit the help names.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "base/parameter.h"

namespace heatsoak {

/// `value` holds the default and is set in the unit of `spec`; a wrong unit or range is a usage error.
CLI::Option* add_quantity(CLI::App& app, const std::string& flag, double& value, const ParameterSpec& spec);

/// A check for options: a whole number from 0 to `most`. CLI11 takes -1 for 2^64 − 1, a number too large for the largest
/// one, and 010 for 8.
std::function<std::string(const std::string&)> whole_number(std::uint64_t most);

/// --seed, a whole number; `seed` holds the default.
CLI::Option* add_seed(CLI::App& app, std::uint64_t& seed, const std::string& meaning);

/// --plot FILE.svg; another ending is a usage error, because nothing else is drawn.
CLI::Option* add_picture(CLI::App& app, std::string& file, const std::string& meaning);

/// --out FILE.csv; another ending is a usage error.
CLI::Option* add_table(CLI::App& app, std::string& file, const std::string& meaning);

}  // namespace heatsoak
