// Location of third-party recordings. Tests that need them are skipped without them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace heatsoak {

/// Returns a folder of HEATSOAK_MEASURED_DATA, or of shared/data in a folder above the sources.
inline std::optional<std::filesystem::path> measured_data(const std::string& folder = "") {
  if (const char* given = std::getenv("HEATSOAK_MEASURED_DATA")) {
    const std::filesystem::path path = std::filesystem::path(given) / folder;
    return std::filesystem::exists(path) ? std::optional(path) : std::nullopt;
  }
  for (std::filesystem::path above = HEATSOAK_SOURCE_DIR; above.has_relative_path(); above = above.parent_path()) {
    const std::filesystem::path path = above.parent_path() / "shared/data" / folder;
    if (std::filesystem::exists(path)) {
      return path;
    }
  }
  return std::nullopt;
}

}  // namespace heatsoak
