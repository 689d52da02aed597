// What the verbs that make a thermal guard share: which motor, and how careful the derating is.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

#include "cli/named_files.h"
#include "derate/derating.h"

namespace heatsoak {

struct GuardOptions {
  std::string motor;
  std::string model;
  std::map<std::string, std::string> conditions;
  DerateOptions derate;
};

/// --motor, --model, --condition.
void add_motor_options(CLI::App& app, GuardOptions& options);
/// --ambient, --coldest, --approach, --confidence, --error, --size, --samples, --seed, --threads.
void add_derate_options(CLI::App& app, DerateOptions& options);

/// The model takes the motor's place; where both are named it must be a model of that motor. Throws Failure (bad_input), also with what
/// `named` has found before.
Motor guarded_motor(const GuardOptions& options, NamedFiles& named);

/// Throws Failure (bad_input) where options contradict each other.
void check_derate_options(const DerateOptions& options);

}  // namespace heatsoak
