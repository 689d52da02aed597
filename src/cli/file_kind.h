// What a TOML file of a user describes.
#pragma once

#include <filesystem>

namespace heatsoak {

enum class FileKind { motor, robot, duty };

/// By its keys; what is neither robot nor duty counts as a motor. Throws Failure (bad_input) where it is no TOML.
FileKind file_kind(const std::filesystem::path& file);

}  // namespace heatsoak
