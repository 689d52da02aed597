// Kind of a user's TOML file.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/diagnostic.h"
#include "input/document.h"

namespace heatsoak::duty {

enum class FileKind { motor, robot, duty };

std::string_view to_string(FileKind kind);

/// Returns the kind determined from the keys; nothing if they do not determine it.
std::optional<FileKind> evident_kind(const input::Value& root);

/// Returns the kind of a file; motor if the keys do not determine it. Throws Failure (bad_input) if the file is not valid TOML.
FileKind file_kind(const std::filesystem::path& file);

/// Returns the Failure for a file of this kind where one with other contents was expected.
base::Failure other_kind(const std::filesystem::path& file, FileKind kind, std::string_view expected);

}  // namespace heatsoak::duty
