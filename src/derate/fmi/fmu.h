// Functional mock-up units (FMI 2.0 and 3.0, co-simulation) with their sources. Standard: https://fmi-standard.org.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak {

enum class FmiVersion { fmi2, fmi3 };
enum class FmuCausality { independent, input, parameter, output, constant };
enum class FmuType { real, boolean, enumeration };

/// Its place in the list is its value reference.
struct FmuVariable {
  std::string name;       ///< an identifier of C
  std::string_view unit;  ///< one of fmu_units(); empty for none
  FmuCausality causality = FmuCausality::input;
  FmuType type = FmuType::real;
  double value = 0.0;  ///< at the start; not of outputs
  std::string description;
  bool is_sampled = false;  ///< of an output: changes at calls of the firmware only
};

struct FmuItem {
  std::string_view name;
  std::string_view description;
};

struct FmuFile {
  std::string path;  ///< in the archive
  std::string content;
};

/// What both versions of FMI have in common.
struct FmuModel {
  std::string identifier;   ///< of files and of the shared library
  std::string description;  ///< one line
  std::string token;        ///< guid, instantiation token: kind, program and hash of the inputs
  std::string provenance;   ///< lines for people
  std::vector<FmuVariable> variables;
  std::vector<FmuItem> items;  ///< of the only enumeration, from 0
  std::vector<FmuFile> sources;
  double step_s = 0.1;  ///< of the default experiment
  std::optional<double> fixed_step_s;
};

/// Motor with its effects, nominal values: current, speed and air in, temperatures of all nodes out. Throws Failure (bad_input) with the
/// name of an effect that no simulation can feed, because it goes with a column of logs.
FmuModel motor_fmu(const Derating& derating, std::string_view exporter);

/// The firmware's guard: the exported C header compiled in.
FmuModel guard_fmu(const Derating& derating, std::string_view exporter);

/// Variables, start values and kinds as C, and what `more` adds to the header of them.
std::vector<FmuFile> fmu_tables(const FmuModel& model, std::string_view more);

/// "0.5", "25.0": shortest text that reads back the same, in parentheses where negative.
std::string fmu_number(double value);
std::string_view fmu_unit(std::string_view variable);

/// Every file of the unit, sources and description, in the order of their paths.
std::vector<FmuFile> fmu_files(const FmuModel& model, FmiVersion version);

/// With the shared library for this machine that `compiler` (a C99 compiler: "cc") makes of the sources. Throws Failure (bad_input) with
/// the compiler's words where it makes none.
std::vector<FmuFile> with_binary(std::vector<FmuFile> files, const FmuModel& model, FmiVersion version, const std::string& compiler);

/// A ZIP archive: the same bytes for the same files.
std::string zip_archive(const std::vector<FmuFile>& files);

}  // namespace heatsoak
