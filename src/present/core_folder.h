// Document and JSON of `generate core`.
#pragma once

#include <string>

#include "firmware/core_files.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document core_folder_document(const CoreFolder& folder, const Derating& derating, const CoreOptions& options, const std::string& out);
Json core_folder_json(const CoreFolder& folder, const Derating& derating, const Motor& motor, const CoreOptions& options,
                      const std::string& out);

}  // namespace heatsoak::present
