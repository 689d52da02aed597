#include "present/written_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "present/shell_word.h"

namespace heatsoak::present {
namespace {

constexpr std::ptrdiff_t kMostListed = 8;

bool is_inside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::filesystem::path below = file.lexically_normal().lexically_relative(folder.lexically_normal());
  return !folder.empty() && !below.empty() && below != "." && *below.begin() != "..";
}

}  // namespace

std::vector<std::string> names_of_written(std::span<const std::filesystem::path> files, std::span<const std::filesystem::path> folders) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) {
    std::string name = file.string();
    for (const std::filesystem::path& folder : folders) {
      const auto inside = std::ranges::count_if(files, [&](const std::filesystem::path& each) { return is_inside(each, folder); });
      if (inside > kMostListed && is_inside(file, folder)) {
        name = fmt::format("{} ({} files)", folder.string(), inside);
      }
    }
    if (std::ranges::find(names, name) == names.end()) {
      names.push_back(std::move(name));
    }
  }
  return names;
}

Document new_file_document(const std::string& kind, const std::string& file) {
  return short_answer(fmt::format("{}: replace every \"?\", then run `heatsoak lint {}`", file, shell_word(file)),
                      {{"schema", "heatsoak.new/1"}, {"kind", kind}, {"file", file}});
}

Document manual_document(std::size_t pages, const std::filesystem::path& folder) {
  return short_answer(fmt::format("{} in {}", base::counted(pages, "page"), folder.string()),
                      {{"schema", "heatsoak.manual/1"}, {"pages", pages}, {"folder", folder.string()}});
}

}  // namespace heatsoak::present
