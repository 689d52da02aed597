// Document and JSON of `generate core`.
#pragma once

#include <string>

#include "firmware/core_files.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Names of what a drive core is generated for, and the folder `out`.
struct CoreInput {
  const robot::Robot& robot;
  const motor::Motor& motor;
  const firmware::CoreOptions& options;
  const std::string& out;
};
Document core_folder_document(const CoreInput& input, const firmware::GeneratedCore& core);
/// Without the keys of the notes, see add_notes().
Json core_folder_json(const CoreInput& input, const firmware::GeneratedCore& core);

}  // namespace heatsoak::present
