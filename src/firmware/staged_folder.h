// A folder that appears complete or not at all.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "base/delayed_signals.h"
#include "firmware/core_files.h"

namespace heatsoak::firmware {

/// Throws Failure (bad_input) where `folder` could not be made: its parent is missing, it is a file or without write permission, or it
/// holds something and `may_replace` is not set.
void check_target_folder(const std::filesystem::path& folder, bool may_replace);

/// Files under a temporary name beside their folder; commit() gives them its name, and without it nothing is left.
class StagedFolder {
 public:
  /// Writes the files. In a folder that may be replaced, files are kept that no earlier run generated (kGeneratedFiles). Throws Failure
  /// (bad_input), also where such a file is in the place of a new one.
  StagedFolder(const std::filesystem::path& folder, std::span<const CoreFile> files, bool may_replace);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  ~StagedFolder();

  void commit();

 private:
  void write(std::span<const CoreFile> files) const;

  base::DelayedSignals delayed_;  ///< until the temporary folder has its name or is removed
  std::filesystem::path folder_;
  std::filesystem::path stage_;
};

}  // namespace heatsoak::firmware
