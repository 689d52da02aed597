// Reads the bytes of a plain or gzip-compressed file through a window of bounded size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "duty/import_report.h"

namespace heatsoak::duty {

class LogBytes {
 public:
  /// Throws Failure (bad_input) if the file cannot be opened or is not a regular file.
  explicit LogBytes(const std::filesystem::path& file);
  LogBytes(const LogBytes&) = delete;
  LogBytes& operator=(const LogBytes&) = delete;
  ~LogBytes();

  /// Returns the next bytes: at least `wanted` (at most kWindow) unless the file ends first. The view is valid until the next call.
  [[nodiscard]] std::string_view peek(std::size_t wanted);
  /// Skips `count` bytes, or all remaining bytes if there are fewer.
  void skip(std::uint64_t count);
  /// Returns the position in the uncompressed bytes.
  [[nodiscard]] std::uint64_t offset() const;
  [[nodiscard]] bool is_packed() const;
  /// Returns why the bytes end early; nothing if they do not.
  [[nodiscard]] const std::optional<BytesEndEarly>& broken() const;
  /// Returns the share of the file that has been read, 0 to 1.
  [[nodiscard]] double share() const;

  static constexpr std::size_t kWindow = std::size_t{1} << 22;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heatsoak::duty
