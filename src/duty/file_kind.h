// What a TOML file of a user describes.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "input/document.h"

namespace heatsoak::duty {

enum class FileKind { motor, robot, duty };

std::string_view to_string(FileKind kind);

/// By its keys; nothing where they tell too little.
std::optional<FileKind> evident_kind(const input::Value& root);

/// The same of a file; what does not tell counts as a motor. Throws Failure (bad_input) where it is no TOML.
FileKind file_kind(const std::filesystem::path& file);

}  // namespace heatsoak::duty
