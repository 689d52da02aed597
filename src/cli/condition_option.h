// --condition KEY=VALUE: what is known to hold of the effects that a motor has under conditions.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

namespace heatsoak {

CLI::Option* add_conditions(CLI::App& app, std::map<std::string, std::string>& conditions);

}  // namespace heatsoak
