// Kind of a user's TOML file.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "input/document.h"

namespace heatsoak::duty {

enum class FileKind { motor, robot, duty };

std::string_view to_string(FileKind kind);

/// Returns the kind determined from the keys; nothing if they do not determine it.
std::optional<FileKind> evident_kind(const input::Value& root);

/// Returns the kind of a file; motor if the keys do not determine it. Throws Failure (bad_input) if the file is not valid TOML.
FileKind file_kind(const std::filesystem::path& file);

}  // namespace heatsoak::duty
