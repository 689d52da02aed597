#include "present/written_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "present/shell_word.h"

namespace heatsoak::present {

Document new_file_document(const std::string& kind, const std::string& file) {
  return short_answer(fmt::format("{}: replace every \"?\", then run `heatsoak lint {}`", file, shell_word(file)),
                      {{"schema", "heatsoak.new/1"}, {"kind", kind}, {"file", file}});
}

Document manual_document(std::size_t pages, const std::filesystem::path& folder) {
  return short_answer(fmt::format("{} in {}", base::counted(pages, "page"), folder.string()),
                      {{"schema", "heatsoak.manual/1"}, {"pages", pages}, {"folder", folder.string()}});
}

}  // namespace heatsoak::present
