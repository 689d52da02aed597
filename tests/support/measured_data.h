// Location of third-party recordings. Tests that need them are skipped without them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "skip_reasons.h"

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

/// Returns why measured_data(folder) found nothing. A skip for this reason fails in CI, which has to provide the recordings.
inline std::string why_no_measured_data(const std::string& folder = "") {
  const std::string wanted = folder.empty() ? "recordings" : "recordings of " + folder;
  if (const char* given = std::getenv("HEATSOAK_MEASURED_DATA")) {
    return HEATSOAK_FAILS_CI "HEATSOAK_MEASURED_DATA=" + std::string(given) + " has no " + wanted;
  }
  if (const std::optional<std::filesystem::path> found = measured_data()) {
    return HEATSOAK_FAILS_CI + found->string() + " has no " + wanted;
  }
  return HEATSOAK_FAILS_CI "no " + wanted + ": HEATSOAK_MEASURED_DATA is not set, and no folder above the sources has shared/data";
}

/// Skips the test if the recordings of a folder (all if empty) are not available.
#define SKIP_WITHOUT_MEASURED_DATA(folder)                    \
  do {                                                        \
    if (!heatsoak::measured_data(folder)) {                   \
      GTEST_SKIP() << heatsoak::why_no_measured_data(folder); \
    }                                                         \
  } while (false)

}  // namespace heatsoak
