// Reads the records of an SSL_LOG_FILE in order and skips damaged parts.
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
  /// Reads the file header. Throws Failure (bad_input) if it is not that of an SSL log.
  SslLogStream(LogBytes& bytes, const std::filesystem::path& file, LogEvents& events);

  /// Returns the next record; nothing at the end of the log, at a truncation, or after a long damaged part.
  std::optional<SslRecord> next();
  /// Reports that the last record cannot be decoded. Its size may be wrong, too, so next() may search for a new record.
  void reject(MessageKind kind);

 private:
  bool find_header();
  bool pass_over_damage();
  void pass_over_index(std::uint64_t whole);

  LogBytes& bytes_;
  LogEvents& events_;
  std::uint64_t to_skip_ = 0;     // size of the last returned record
  bool next_is_header_ = false;   // another header follows that record
  std::uint64_t last_given_ = 0;  // offset of the last record with content
};

inline constexpr std::string_view kSslMagic = "SSL_LOG_FILE";

}  // namespace heatsoak::duty
