#include "duty/log_bytes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"

namespace heatsoak::duty {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr int kGzipWindow = 15 + 16;  // zlib's code for a gzip header and checksum

}  // namespace

struct LogBytes::State {
  struct Close {
    void operator()(std::FILE* opened) const { (void)std::fclose(opened); }
  };

  std::unique_ptr<std::FILE, Close> file;
  std::uint64_t file_size = 0;
  std::uint64_t file_read = 0;
  std::vector<unsigned char> packed;  // empty if the file is not compressed
  z_stream zip{};
  bool zip_open = false;
  bool between_members = false;
  std::unique_ptr<char[]> window = std::make_unique_for_overwrite<char[]>(kWindow);
  std::size_t begin = 0;
  std::size_t end = 0;
  std::uint64_t offset = 0;
  bool at_end = false;
  std::optional<BytesEndEarly> broken;

  ~State() {
    if (zip_open) {
      (void)inflateEnd(&zip);
    }
  }

  std::size_t read(void* into, std::size_t count) {
    const std::size_t got = std::fread(into, 1, count, file.get());
    file_read += got;
    if (got < count && std::ferror(file.get()) != 0) {
      broken = BytesEndEarly{BytesEndEarly::Cause::unreadable, file_read, std::strerror(errno)};
    }
    return got;
  }

  void open_zip() {
    packed.resize(kChunk);
    zip_open = inflateInit2(&zip, kGzipWindow) == Z_OK;
    if (!zip_open) {
      throw base::Failure(base::ExitCode::bug, "zlib cannot be initialized");
    }
  }

  /// Returns the position of the next input byte in the file.
  [[nodiscard]] std::uint64_t packed_offset() const { return file_read - zip.avail_in; }

  /// Decompresses into the window; returns false at the end.
  bool unpack() {
    zip.next_out = reinterpret_cast<Bytef*>(window.get() + end);
    zip.avail_out = static_cast<uInt>(kWindow - end);
    const uInt room = zip.avail_out;
    while (zip.avail_out == room) {
      if (zip.avail_in == 0) {
        zip.next_in = packed.data();
        zip.avail_in = static_cast<uInt>(read(packed.data(), packed.size()));
        if (zip.avail_in == 0) {
          if (!between_members && !broken) {
            broken = BytesEndEarly{BytesEndEarly::Cause::cut, file_read, {}};
          }
          return false;
        }
      }
      if (between_members) {
        // Zeros after a gzip member are padding. Other bytes that do not begin a new member are ignored, as gzip does.
        if (zip.next_in[0] != 0x1f || inflateReset2(&zip, kGzipWindow) != Z_OK) {
          return false;
        }
        between_members = false;
      }
      const int result = inflate(&zip, Z_NO_FLUSH);
      if (result == Z_STREAM_END) {
        between_members = true;
      } else if (result != Z_OK && result != Z_BUF_ERROR) {
        broken = BytesEndEarly{BytesEndEarly::Cause::damaged, packed_offset(), zip.msg != nullptr ? zip.msg : "wrong data"};
        break;
      }
    }
    end += room - zip.avail_out;
    return !broken;
  }

  void fill() {
    if (begin > 0) {
      std::memmove(window.get(), window.get() + begin, end - begin);
      end -= begin;
      begin = 0;
    }
    if (zip_open) {
      at_end = !unpack();
    } else {
      const std::size_t got = read(window.get() + end, kWindow - end);
      end += got;
      at_end = got == 0;
    }
  }
};

std::string to_string(const BytesEndEarly& end) {
  switch (end.cause) {
    case BytesEndEarly::Cause::unreadable:
      return fmt::format("byte {} of the file cannot be read: {}", end.byte, end.reason);
    case BytesEndEarly::Cause::cut:
      return fmt::format("the compressed file ends at byte {}, before the end of its data", end.byte);
    case BytesEndEarly::Cause::damaged:
      return fmt::format("the compressed file is damaged near byte {} ({}); the rest cannot be decompressed", end.byte, end.reason);
  }
  return {};
}

LogBytes::LogBytes(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
  State& s = *state_;
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw base::bad_input({file.string()}, "", "is a folder; expected a recorded game");
  }
  s.file.reset(std::fopen(file.c_str(), "rb"));
  if (!s.file) {
    throw base::bad_input({file.string()}, "", fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  base::note_input(file);
  s.file_size = std::filesystem::file_size(file, error);
  if (error) {
    s.file_size = 0;
  }
  (void)std::setvbuf(s.file.get(), nullptr, _IONBF, 0);
  s.end = s.read(s.window.get(), 2);
  if (s.end == 2 && std::memcmp(s.window.get(), "\x1f\x8b", 2) == 0) {
    s.open_zip();
    std::memcpy(s.packed.data(), s.window.get(), 2);
    s.zip.next_in = s.packed.data();
    s.zip.avail_in = 2;
    s.end = 0;
  }
}

LogBytes::~LogBytes() = default;

std::string_view LogBytes::peek(std::size_t wanted) {
  State& s = *state_;
  wanted = std::min(wanted, kWindow);
  while (s.end - s.begin < wanted && !s.at_end) {
    s.fill();
  }
  return {s.window.get() + s.begin, s.end - s.begin};
}

void LogBytes::skip(std::uint64_t count) {
  State& s = *state_;
  while (count > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(count, s.end - s.begin));
    s.begin += step;
    s.offset += step;
    count -= step;
    if (count > 0 && peek(1).empty()) {
      return;
    }
  }
}

std::uint64_t LogBytes::offset() const { return state_->offset; }
bool LogBytes::is_packed() const { return state_->zip_open; }
const std::optional<BytesEndEarly>& LogBytes::broken() const { return state_->broken; }

double LogBytes::share() const {
  const State& s = *state_;
  return s.file_size == 0 ? 0.0 : std::min(1.0, static_cast<double>(s.file_read) / static_cast<double>(s.file_size));
}

}  // namespace heatsoak::duty
