#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <memory>
#include <new>

#include "base/diagnostic.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate {
namespace {

void require(archive* zip, int code) {
  if (code != ARCHIVE_OK) {
    throw base::Failure(base::ExitCode::bug, fmt::format("the archive cannot be made: {}", archive_error_string(zip)));
  }
}

la_ssize_t take(archive* /*zip*/, void* to, const void* bytes, std::size_t size) {
  try {
    static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), size);
    return static_cast<la_ssize_t>(size);
  } catch (const std::bad_alloc&) {
    return -1;
  }
}

}  // namespace

std::string zip_archive(const std::vector<FmuFile>& files) {
  std::string bytes;
  const std::unique_ptr<archive, int (*)(archive*)> zip(archive_write_new(), &archive_write_free);
  require(zip.get(), archive_write_set_format_zip(zip.get()));
  // Without this libarchive fills the last block with zeros, up to 10240 bytes.
  require(zip.get(), archive_write_set_bytes_in_last_block(zip.get(), 1));
  require(zip.get(), archive_write_open(zip.get(), &bytes, nullptr, &take, nullptr));
  for (const FmuFile& file : files) {
    const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(), &archive_entry_free);
    archive_entry_set_pathname(entry.get(), file.path.c_str());
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    constexpr __LA_MODE_T kMode = 0644;
    archive_entry_set_perm(entry.get(), kMode);
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(file.content.size()));
    // No time is set, so libarchive writes 1980-01-01 in every time zone and the archive is reproducible.
    require(zip.get(), archive_write_header(zip.get(), entry.get()));
    if (archive_write_data(zip.get(), file.content.data(), file.content.size()) != static_cast<la_ssize_t>(file.content.size())) {
      throw base::Failure(base::ExitCode::bug, fmt::format("the archive cannot be made: {}", archive_error_string(zip.get())));
    }
  }
  require(zip.get(), archive_write_close(zip.get()));
  return bytes;
}

}  // namespace heatsoak::derate
