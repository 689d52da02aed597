// Document and JSON of `generate core`.
#pragma once

#include <string>

#include "firmware/core_files.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document core_folder_document(const firmware::CoreFolder& folder, const derate::Derating& derating, const firmware::CoreOptions& options,
                              const std::string& out);
/// Without the keys of the notes, see add_notes().
Json core_folder_json(const firmware::CoreFolder& folder, const derate::Derating& derating, const motor::Motor& motor,
                      const firmware::CoreOptions& options, const std::string& out);

}  // namespace heatsoak::present
