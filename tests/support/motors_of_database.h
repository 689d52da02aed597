// Names of the motors in motor_db, for tests over the whole database.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "source_folder.h"

namespace heatsoak {

/// Returns the ids of all motors of the database, sorted.
inline std::vector<std::string> motors_of_database() {
  std::vector<std::string> ids;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "motor_db")) {
    if (entry.path().extension() == ".toml") {
      ids.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(ids);
  return ids;
}

}  // namespace heatsoak
