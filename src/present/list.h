// The answer of `list`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "input/data_folders.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the kinds of names that can be listed, such as "motors".
std::vector<std::string> listed_kinds();

/// Table of numbers that a verb writes.
struct TableOutput {
  std::string ending;  ///< ending of the file, with the dot
  std::string content;
  std::string command;  ///< verb and option: "simulate --out"
};

/// Returns ids and summaries as a table without a head and without a headline, so that the quiet form shows only the ids. Throws Failure
/// (bad_input) for another kind, and if a folder has no files. `tables` are formats, too.
Document list_document(const std::string& kind, const input::DataFolders& folders, std::span<const TableOutput> tables = {});

}  // namespace heatsoak::present
