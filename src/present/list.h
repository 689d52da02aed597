// The answer of `list`.
#pragma once

#include <string>
#include <vector>

#include "input/data_folders.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the kinds of names that can be listed, such as "motors".
std::vector<std::string> listed_kinds();

/// Returns ids and summaries as a table without a head and without a headline, so that the quiet form shows only the ids. Throws Failure
/// (bad_input) for another kind, and if a folder has no files.
Document list_document(const std::string& kind, const input::DataFolders& folders);

}  // namespace heatsoak::present
