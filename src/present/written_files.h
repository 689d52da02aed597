// Documents of `new` and `manual`, whose answer is the files that they write.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "present/document.h"

namespace heatsoak::present {

/// `kind` of the new file: "motor" or "robot".
Document new_file_document(const std::string& kind, const std::string& file);

Document manual_document(std::size_t pages, const std::filesystem::path& folder);

}  // namespace heatsoak::present
