#include "duty/ssl_log_stream.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/diagnostic.h"

namespace heatsoak::duty {
namespace {

constexpr std::size_t kHeader = 16;  // size of the header of the file and of each record
constexpr std::int32_t kLastPlausibleType = 63;
constexpr std::int64_t kLargestDatagram = 65'535;
constexpr std::int64_t kLargestMessage = 1 << 20;
constexpr std::int64_t kLatest_ns = 4'102'444'800'000'000'000;  // the year 2100
constexpr std::int64_t kNeighbours_ns = 3'600'000'000'000;      // largest time difference of adjacent records: one hour
constexpr std::uint64_t kLongestDamage = std::uint64_t{1} << 28;

std::uint64_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

struct Header {
  std::int64_t received_ns = 0;
  std::int32_t type = 0;
  std::int64_t size = 0;
};

Header header_at(std::string_view bytes, std::size_t at) {
  return {static_cast<std::int64_t>(big_endian(bytes, at, 8)), static_cast<std::int32_t>(big_endian(bytes, at + 8, 4)),
          static_cast<std::int32_t>(big_endian(bytes, at + 12, 4))};
}

bool is_datagram(std::int32_t type) {
  return type >= static_cast<std::int32_t>(SslMessageType::vision_2010) && type <= static_cast<std::int32_t>(SslMessageType::tracker_2020);
}

bool is_plausible(const Header& h) {
  if (h.type < 0 || h.type > kLastPlausibleType || h.size < 0 || h.received_ns < 0 || h.received_ns > kLatest_ns) {
    return false;
  }
  if (h.type == static_cast<std::int32_t>(SslMessageType::index_2021)) {
    return true;  // one number for each message of the log, so of any size
  }
  return h.size <= (is_datagram(h.type) ? kLargestDatagram : kLargestMessage);
}

/// Result of checking a record after damage. It must be usable, and another record must follow it.
enum class Candidate { no, yes, needs_more };
Candidate candidate_at(std::string_view bytes, std::size_t at, bool is_all) {
  const Header h = header_at(bytes, at);
  if (!is_datagram(h.type) || h.size == 0 || !is_plausible(h)) {
    return Candidate::no;
  }
  const std::size_t next = at + kHeader + static_cast<std::size_t>(h.size);
  if (next + kHeader > bytes.size()) {
    return !is_all ? Candidate::needs_more : next == bytes.size() ? Candidate::yes : Candidate::no;
  }
  const Header after = header_at(bytes, next);
  return is_plausible(after) && std::abs(after.received_ns - h.received_ns) <= kNeighbours_ns ? Candidate::yes : Candidate::no;
}

}  // namespace

SslLogStream::SslLogStream(LogBytes& bytes, const std::filesystem::path& file, LogEvents& events) : bytes_(bytes), events_(events) {
  const std::string_view head = bytes_.peek(kHeader);
  if (head.size() < kHeader || !head.starts_with(kSslMagic)) {
    throw base::bad_input({file.string()}, "",
                          fmt::format("is not an SSL log: its first {} bytes are not \"{}\" and a version{}", kHeader, kSslMagic,
                                      bytes_.broken() ? fmt::format("; {}", to_string(*bytes_.broken())) : ""));
  }
  const auto version = static_cast<std::int32_t>(big_endian(head, kSslMagic.size(), 4));
  if (version != 1) {
    throw base::bad_input({file.string()}, "",
                          fmt::format("byte {}: SSL log of version {}; expected version 1", kSslMagic.size(), version));
  }
  bytes_.skip(kHeader);
  last_given_ = kHeader;
}

/// Advances to the next record after damage; returns false if there is none.
bool SslLogStream::find_header() {
  const std::uint64_t begin = bytes_.offset();
  std::size_t at = 1;
  while (true) {
    const std::string_view view = bytes_.peek(LogBytes::kWindow);
    const bool is_all = view.size() < LogBytes::kWindow;
    for (; at + kHeader <= view.size(); ++at) {
      // Usable types and sizes begin with a zero byte, which quickly excludes most positions.
      if (view[at + 8] != 0 || view[at + 12] != 0) {
        continue;
      }
      const Candidate candidate = candidate_at(view, at, is_all);
      if (candidate == Candidate::needs_more) {
        break;
      }
      if (candidate == Candidate::yes) {
        bytes_.skip(at);
        events_.problem(begin, BytesSkipped{bytes_.offset() - begin});
        return true;
      }
    }
    if (is_all) {
      return false;
    }
    bytes_.skip(at);
    at = 0;
    if (bytes_.offset() - begin > kLongestDamage) {
      events_.problem(begin, RestNotRead{.bytes = bytes_.offset() - begin});
      return false;
    }
  }
}

/// Skips an index record. It has one number for each message, so it may be larger than the window.
void SslLogStream::pass_over_index(std::uint64_t whole) {
  const std::uint64_t begin = bytes_.offset();
  bytes_.skip(whole);
  ++events_.report().messages;
  if (bytes_.offset() < begin + whole) {
    events_.report().truncated_at = begin;
  }
}

bool SslLogStream::pass_over_damage() {
  if (find_header()) {
    return true;
  }
  const std::size_t rest = bytes_.peek(LogBytes::kWindow).size();
  if (rest < LogBytes::kWindow) {
    events_.problem(bytes_.offset(), EndsWithoutMessage{rest});
  }
  return false;
}

std::optional<SslRecord> SslLogStream::next() {
  bytes_.skip(to_skip_);
  to_skip_ = 0;
  while (true) {
    const std::string_view head = bytes_.peek(kHeader);
    const std::uint64_t idle = bytes_.offset() - last_given_;
    if (head.empty()) {
      return std::nullopt;
    }
    if (idle > kLongestDamage) {
      events_.problem(last_given_, RestNotRead{.bytes = idle, .has_empty_messages = true});
      return std::nullopt;
    }
    if (head.size() < kHeader) {
      events_.report().truncated_at = bytes_.offset();
      return std::nullopt;
    }
    const Header h = header_at(head, 0);
    if (!is_plausible(h)) {
      if (!pass_over_damage()) {
        return std::nullopt;
      }
      continue;
    }
    const std::uint64_t whole = kHeader + static_cast<std::uint64_t>(h.size);
    if (h.type == static_cast<std::int32_t>(SslMessageType::index_2021)) {
      pass_over_index(whole);
      continue;
    }
    const std::uint64_t here = bytes_.offset();
    const std::string_view view = bytes_.peek(static_cast<std::size_t>(whole) + kHeader);
    if (view.size() < whole) {
      // Either the log ends here, or the size is wrong and more records follow.
      if (!find_header()) {
        events_.report().truncated_at = here;
        return std::nullopt;
      }
      continue;
    }
    next_is_header_ = view.size() < whole + kHeader || is_plausible(header_at(view, static_cast<std::size_t>(whole)));
    to_skip_ = whole;
    last_given_ = h.size > 0 ? here : last_given_;
    return SslRecord{here, h.received_ns, static_cast<SslMessageType>(h.type), view.substr(kHeader, static_cast<std::size_t>(h.size))};
  }
}

void SslLogStream::reject(MessageKind kind) {
  events_.problem(bytes_.offset(), MessageUndecodable{kind});
  if (!next_is_header_) {
    to_skip_ = find_header() ? 0 : bytes_.peek(LogBytes::kWindow).size();
  }
}

}  // namespace heatsoak::duty
