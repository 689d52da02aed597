// Reading and writing whole files, with the reason where it fails.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace heatsoak {

/// All bytes of a regular file of at most `largest_bytes`; else Failure (bad_input).
std::string read_file(const std::filesystem::path& path, std::size_t largest_bytes);

/// Writes `content` under a temporary name beside `path` and renames it, so that no half file is left; a link is
/// followed, and a device or pipe takes the bytes as they come. Throws Failure (bad_input).
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace heatsoak
