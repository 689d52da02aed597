// Options that take a quantity: "6A", "4 s", "25degC", or a bare number in the unit the help names.
#pragma once

#include <CLI/App.hpp>

#include "base/parameter.h"

namespace heatsoak {

/// `value` holds the default and is set in the unit of `spec`; a wrong unit or range is a usage error.
CLI::Option* add_quantity(CLI::App& app, const std::string& flag, double& value, const ParameterSpec& spec);

/// --plot FILE.svg; another ending is a usage error, because nothing else is drawn.
CLI::Option* add_picture(CLI::App& app, std::string& file, const std::string& meaning);

}  // namespace heatsoak
