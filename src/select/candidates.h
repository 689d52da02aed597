// Resolves names on the command line to the motors to evaluate.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "duty/named_files.h"

namespace heatsoak::select {

struct CandidateNames {
  std::vector<std::string> motors;                     ///< ids or files; "all": the whole data base
  std::string model = {};                              ///< a calibrated motor that replaces the one it was fitted from; empty: none
  std::map<std::string, std::string> conditions = {};  ///< conditions for under()
};

/// Reads the model, then the motors in the order of their names, each once. `files` collects problems of files. Throws Failure (bad_input)
/// if two files have the same id.
std::vector<motor::Motor> named_candidates(const CandidateNames& names, duty::NamedFiles& files);

/// Returns the motors of the data base under `conditions`. Files with problems are omitted.
std::vector<motor::Motor> motors_of_database(const input::DataFolders& folders, const std::map<std::string, std::string>& conditions);

}  // namespace heatsoak::select
