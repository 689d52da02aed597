// The bytes of a file, packed by gzip or not, through a window of bounded size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace heatsoak::duty {

class LogBytes {
 public:
  /// Throws Failure (bad_input) where the file cannot be opened or is no file.
  explicit LogBytes(const std::filesystem::path& file);
  LogBytes(const LogBytes&) = delete;
  LogBytes& operator=(const LogBytes&) = delete;
  ~LogBytes();

  /// The next bytes: at least `wanted` of them (at most kWindow) unless the file ends before. Valid until the next call.
  [[nodiscard]] std::string_view peek(std::size_t wanted);
  /// Goes on; `count` may be larger than what is left.
  void skip(std::uint64_t count);
  /// Position in the unpacked bytes.
  [[nodiscard]] std::uint64_t offset() const;
  [[nodiscard]] bool is_packed() const;
  /// Why the bytes end early, with the place in the file; empty where they do not.
  [[nodiscard]] const std::string& broken() const;
  /// Share of the file that is read.
  [[nodiscard]] double share() const;

  static constexpr std::size_t kWindow = std::size_t{1} << 22;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heatsoak::duty
