// Options shared by the commands that generate a thermal guard: the motor and the safety of the derating.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

#include "derate/derating.h"
#include "duty/named_files.h"

namespace heatsoak::cli {

struct GuardOptions {
  std::string motor;
  std::string model;
  std::map<std::string, std::string> conditions;
  derate::DerateOptions derate;
};

/// --motor, --model, --condition.
void add_motor_options(CLI::App& app, GuardOptions& options);
/// --ambient, --coldest, --approach, --confidence, --error, --size, --samples, --seed, --threads.
void add_derate_options(CLI::App& app, derate::DerateOptions& options);

/// Returns the motor to guard. A model replaces the motor; if both are named, it must be a model of that motor. Throws Failure (bad_input),
/// also with the problems that `named` has collected before.
motor::Motor guarded_motor(const GuardOptions& options, duty::NamedFiles& named);

/// Throws Failure (bad_input) if options contradict each other.
void check_derate_options(const derate::DerateOptions& options);

}  // namespace heatsoak::cli
