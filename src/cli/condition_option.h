// Option --condition KEY=VALUE: states which conditions of the motor's conditional effects hold.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

namespace heatsoak::cli {

CLI::Option* add_conditions(CLI::App& app, std::map<std::string, std::string>& conditions);

}  // namespace heatsoak::cli
