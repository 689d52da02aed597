// Documents and JSON of `simulate`: a match in the closed loop, or one motor under a prescribed load.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "present/document.h"
#include "present/json.h"
#include "select/load_simulation.h"
#include "simulate/match_simulation.h"

namespace heatsoak::present {

/// Words of the user's command, ids or files, that the suggested command repeats.
struct GivenInputs {
  std::string robot;
  std::string duty;
  std::string motor = {};     ///< empty if `model` is given
  std::string model = {};     ///< empty if `motor` is given
  std::string database = {};  ///< folder of --db; may be empty
  std::map<std::string, std::string> conditions = {};
};

/// Returns "with the losses at their 95th percentile", to follow a temperature of the second run of a motor with a forecast band.
std::string upper_losses_words();

Document match_document(const simulate::MatchSimulation& match, const GivenInputs& given);
Json match_json(const simulate::MatchSimulation& match);

/// One part of the energy that left the battery.
struct EnergyPart {
  std::string_view name;  ///< also the key in the JSON, without its unit
  double simulate::EnergyAccount::*value;
};
std::span<const EnergyPart> energy_parts();

Document load_simulation_document(const select::LoadSimulation& simulation, const GivenInputs& given);
Json load_simulation_json(const select::LoadSimulation& simulation);

}  // namespace heatsoak::present
