// The records of an SSL_LOG_FILE, one after another, over damage too.
// Format: "SSL_LOG_FILE", int32 version 1, then records of int64 time of reception in ns, int32 type, int32 size and
// the message; all numbers big endian (RoboCup-SSL/ssl-logtools src/common/format, RoboCup-SSL/ssl-go-tools pkg/persistence).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "duty/log_bytes.h"
#include "duty/log_type.h"

namespace heatsoak::duty {

enum class SslMessageType : std::int32_t {
  blank = 0,
  unknown = 1,
  vision_2010 = 2,
  referee_2013 = 3,
  vision_2014 = 4,
  tracker_2020 = 5,
  index_2021 = 6,
};

struct SslRecord {
  std::uint64_t offset = 0;
  std::int64_t received_ns = 0;
  SslMessageType type = SslMessageType::blank;
  std::string_view message;  ///< valid until the next call of the stream
};

class SslLogStream {
 public:
  /// Reads the file's header; throws Failure (bad_input) where it is none.
  SslLogStream(LogBytes& bytes, const std::filesystem::path& file, LogEvents& events);

  /// The next record. Nothing at the end of the log, which truncation and long damage make, too.
  std::optional<SslRecord> next();
  /// The record that next() gave cannot be decoded: its size may be wrong as well.
  void reject(std::string_view why);

 private:
  bool find_header();
  bool pass_over_damage();
  void pass_over_index(std::uint64_t whole);

  LogBytes& bytes_;
  LogEvents& events_;
  std::uint64_t to_skip_ = 0;     // of the record that was given last
  bool next_is_header_ = false;   // behind that record stands another one
  std::uint64_t last_given_ = 0;  // offset of the last record with content
};

inline constexpr std::string_view kSslMagic = "SSL_LOG_FILE";

}  // namespace heatsoak::duty
