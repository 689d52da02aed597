#include "recording/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

namespace heatsoak::recording {
namespace {

/// FNV-1a hash, identical on every machine.
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) {
      add_byte(static_cast<unsigned char>(bits >> (8 * byte)));
    }
  }
  void add(std::string_view text) {
    std::ranges::for_each(text, [this](char each) { add_byte(static_cast<unsigned char>(each)); });
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 1'099'511'628'211ULL; }
  std::uint64_t value_ = 14'695'981'039'346'656'037ULL;
};

/// Bits of a value in single precision, because the order of arithmetic in a mapping may change the last digits of a double.
std::uint64_t bits_of(double value) {
  constexpr std::uint64_t kUnknown = ~0ULL;
  return std::isnan(value) ? kUnknown : std::bit_cast<std::uint32_t>(static_cast<float>(value) + 0.0F);
}

struct RowSpan {
  std::string_view content;
  double from_s = 0.0;
  double to_s = 0.0;
};

std::optional<RowSpan> parsed(std::string_view text) {
  const std::size_t blank = text.find(' ');
  const std::size_t dash = text.find('-', blank == std::string_view::npos ? blank : blank + 1);
  if (dash == std::string_view::npos || !text.ends_with(" s")) {
    return std::nullopt;
  }
  RowSpan rows{text.substr(0, blank)};
  const auto number = [&](std::size_t begin, std::size_t end, double& value_s) {
    const auto result = std::from_chars(text.data() + begin, text.data() + end, value_s);
    return result.ec == std::errc() && result.ptr == text.data() + end;
  };
  return number(blank + 1, dash, rows.from_s) && number(dash + 1, text.size() - 2, rows.to_s) ? std::optional(rows) : std::nullopt;
}

constexpr std::size_t kWindow_rows = 60;

/// Rolling hash (Karp and Rabin 1987) of every window of 60 rows; 0 if too few rows differ from the previous one.
std::vector<std::uint64_t> window_hashes(const std::vector<const Channel*>& channels) {
  constexpr std::uint64_t kBase = 0x9E37'79B9'7F4A'7C15ULL;
  constexpr std::size_t kLeastChanging_rows = 40;
  std::uint64_t last_power = 1;
  for (std::size_t i = 0; i < kWindow_rows; ++i) {
    last_power *= kBase;
  }
  const std::size_t rows = channels.empty() ? 0 : channels.front()->values.size();
  std::vector<std::uint64_t> of_row(rows), of_window(rows < kWindow_rows ? 0 : rows - kWindow_rows + 1);
  std::uint64_t rolling = 0;
  std::size_t changing = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    Hash hash;
    std::ranges::for_each(channels, [&](const Channel* channel) { hash.add(bits_of(channel->values[row])); });
    of_row[row] = hash.value();
    rolling = rolling * kBase + of_row[row];
    changing += row > 0 && of_row[row] != of_row[row - 1] ? 1 : 0;
    if (row >= kWindow_rows) {
      rolling -= last_power * of_row[row - kWindow_rows];
      const std::size_t gone = row - kWindow_rows;
      changing -= of_row[gone + 1] != of_row[gone] ? 1 : 0;
    }
    if (row + 1 >= kWindow_rows) {
      of_window[row + 1 - kWindow_rows] = changing >= kLeastChanging_rows ? rolling : 0;
    }
  }
  return of_window;
}

}  // namespace

std::string content_hash(const Recording& recording) {
  constexpr double kTick_s = 1e-6;
  Hash hash;
  for (const double time_s : recording.time_s) {
    hash.add(static_cast<std::uint64_t>(std::llround((time_s - recording.time_s.front()) / kTick_s)));
  }
  std::vector<const Channel*> channels;
  for (const Channel& channel : recording.channels) {
    channels.push_back(&channel);
  }
  // The hash of a log must not change with the name of a quantity, because motor files contain it.
  const auto key = [](const Channel* channel) { return earlier_key(channel->quantity.key); };
  std::ranges::sort(channels, {}, key);
  for (const Channel* channel : channels) {
    hash.add(key(channel));
    std::ranges::for_each(channel->values, [&hash](double each) { hash.add(bits_of(each)); });
  }
  return fmt::format("{:016x}", hash.value());
}

std::string fingerprint_of(const Recording& recording) {
  const bool is_read = !recording.content.empty();
  const double begin_s = is_read ? recording.content_begin_s : recording.time_s.front();
  const auto rounded_s = [begin_s](double time_s) { return std::round(1e3 * (time_s - begin_s)) / 1e3; };
  return fmt::format("{} {}-{} s", is_read ? recording.content : content_hash(recording), rounded_s(recording.time_s.front()),
                     rounded_s(recording.time_s.back()));
}

std::string name_and_fingerprint(const Recording& recording) { return fmt::format("{} ({})", recording.name, fingerprint_of(recording)); }

bool share_rows(std::string_view fingerprint, std::string_view other) {
  const std::optional<RowSpan> one = parsed(fingerprint);
  const std::optional<RowSpan> two = parsed(other);
  return one && two && one->content == two->content && one->from_s < two->to_s && two->from_s < one->to_s;
}

bool is_cut_from(const Recording& part, const Recording& whole) {
  constexpr double kMost_share = 0.5;
  std::vector<const Channel*> of_part, of_whole;
  bool is_of_motor = false;
  for (const Channel& channel : part.channels) {
    if (const Channel* const same = whole.find(channel.quantity.key)) {
      of_part.push_back(&channel);
      of_whole.push_back(same);
      is_of_motor = is_of_motor || channel.quantity.kind == QuantityKind::temperature;
    }
  }
  // Commands may repeat exactly; measured temperatures do not.
  if (!is_of_motor) {
    return false;
  }
  std::unordered_set<std::uint64_t> known;
  const std::vector<std::uint64_t> whole_hashes = window_hashes(of_whole);
  for (std::size_t row = 0; row < whole_hashes.size(); row += kWindow_rows) {
    known.insert(whole_hashes[row]);
  }
  known.erase(0);
  std::size_t same_rows = 0;
  for (const std::uint64_t hash : window_hashes(of_part)) {
    same_rows += known.contains(hash) ? kWindow_rows : 0;
  }
  return static_cast<double>(same_rows) > kMost_share * static_cast<double>(part.rows());
}

bool is_of_run(const Recording& recording, std::string_view run) {
  const std::size_t open = run.rfind(" (");
  if (open != std::string_view::npos && run.ends_with(" s)")) {
    return share_rows(run.substr(open + 2, run.size() - open - 3), fingerprint_of(recording));
  }
  return run.substr(0, run.find('#')) == recording.name;
}

}  // namespace heatsoak::recording
