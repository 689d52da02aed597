// Document of `generate core`.
#pragma once

#include <string>

#include "firmware/core_files.h"
#include "present/document.h"

namespace heatsoak::present {

Document core_folder_document(const CoreFolder& folder, const Derating& derating, const CoreOptions& options, const std::string& out);

}  // namespace heatsoak::present
