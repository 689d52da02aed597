// Reads files of a ZIP archive with libarchive.
#pragma once

#include <archive.h>
#include <archive_entry.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

namespace heatsoak::derate {

inline std::map<std::string, std::string> unpacked(const std::string& bytes) {
  std::map<std::string, std::string> files;
  const std::unique_ptr<archive, int (*)(archive*)> zip(archive_read_new(), &archive_read_free);
  archive_read_support_format_zip(zip.get());
  EXPECT_EQ(archive_read_open_memory(zip.get(), bytes.data(), bytes.size()), ARCHIVE_OK);
  archive_entry* entry = nullptr;
  while (archive_read_next_header(zip.get(), &entry) == ARCHIVE_OK) {
    std::string& content = files[archive_entry_pathname(entry)];
    char part[4096];
    for (la_ssize_t got = 0; (got = archive_read_data(zip.get(), part, sizeof part)) > 0;) {
      content.append(part, static_cast<std::size_t>(got));
    }
  }
  return files;
}

/// Returns an exporter's text, or the texts of all files of its archive.
inline std::string readable(const std::string& exported) {
  if (!exported.starts_with("PK")) {
    return exported;
  }
  std::string text;
  for (const auto& [path, content] : unpacked(exported)) {
    text += content;
  }
  return text;
}

}  // namespace heatsoak::derate
