// The list of files that a command writes, and the documents of `new` and `manual`, whose answer is these files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "present/document.h"

namespace heatsoak::present {

/// Returns the names for the list of written files, in the given order. If more than eight files are inside of one of the `folders`, that
/// folder is listed with their number instead. Empty folders are ignored.
std::vector<std::string> names_of_written(std::span<const std::filesystem::path> files, std::span<const std::filesystem::path> folders);

/// `kind` of the new file: "motor" or "robot".
Document new_file_document(const std::string& kind, const std::string& file);

Document manual_document(std::size_t pages, const std::filesystem::path& folder);

}  // namespace heatsoak::present
