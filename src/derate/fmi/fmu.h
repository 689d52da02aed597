// Functional mock-up units (FMI 2.0 and 3.0, co-simulation) with their sources. Standard: https://fmi-standard.org.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate {

enum class FmiVersion { fmi2, fmi3 };
enum class FmuCausality { independent, input, parameter, output, constant };
enum class FmuType { real, boolean, enumeration };

/// A variable of the unit. Its index in the list is its value reference.
struct FmuVariable {
  std::string name;  ///< a C identifier; a real variable has the unit in which it ends, fmu_unit()
  FmuCausality causality = FmuCausality::input;
  FmuType type = FmuType::real;
  double value = 0.0;  ///< start value; ignored for outputs
  std::string description;
  bool is_sampled = false;  ///< an output that changes only when the firmware is called
};

/// One value of the enumeration, such as a reason of the guard.
struct FmuItem {
  std::string_view name;
  std::string_view description;
};

/// A file of the unit's archive.
struct FmuFile {
  std::string path;  ///< path in the archive
  std::string content;
};

/// Model data that do not depend on the FMI version.
struct FmuModel {
  std::string identifier;   ///< name of files and of the shared library
  std::string description;  ///< one line
  std::string token;        ///< GUID or instantiation token: kind, program and hash of the inputs
  std::string provenance;   ///< human-readable lines
  std::vector<FmuVariable> variables;
  std::vector<FmuItem> items;  ///< values of the only enumeration, from 0
  std::vector<FmuFile> sources;
  double step_s = 0.1;  ///< step size of the default experiment
  std::optional<double> fixed_step_s;
};

/// Model of the nominal motor with its effects. Inputs: current, speed and air; outputs: temperatures of all nodes. Throws Failure
/// (bad_input) with the effect's name if an effect depends on a log column, which a simulation cannot provide.
FmuModel motor_fmu(const Derating& derating, std::string_view exporter);

/// Model of the firmware's guard, which contains the exported C header.
FmuModel guard_fmu(const Derating& derating, std::string_view exporter);

/// Generates C files with variables, start values and types; appends the text `more` to their header.
std::vector<FmuFile> fmu_tables(const FmuModel& model, std::string_view more);

/// Returns the value with at most 12 digits, such as "0.5" or "25.0"; in parentheses if negative.
std::string fmu_number(double value);
/// Returns the unit in which the name of a real variable ends, such as "degC" of "winding_C"; empty if there is none.
std::string fmu_unit(const FmuVariable& variable);

/// Returns every file of the unit, sources and description, sorted by path.
std::vector<FmuFile> fmu_files(const FmuModel& model, FmiVersion version);

/// Adds the shared library for this machine, built from the sources with a C99 compiler such as "cc". Throws Failure (bad_input) with the
/// compiler's output if the build fails.
std::vector<FmuFile> with_binary(std::vector<FmuFile> files, const FmuModel& model, FmiVersion version, const std::string& compiler);

/// Returns a ZIP archive. Its bytes depend only on the files.
std::string zip_archive(const std::vector<FmuFile>& files);

}  // namespace heatsoak::derate
