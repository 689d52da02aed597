#include "identify/measurement/recording.h"

#include <algorithm>

namespace heatsoak {

const Channel* Recording::find(std::string_view key) const {
  const auto found = std::ranges::find_if(channels, [key](const Channel& channel) { return channel.quantity.key == key; });
  return found == channels.end() ? nullptr : &*found;
}

std::vector<std::pair<std::size_t, std::size_t>> Recording::runs() const {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < run_begins.size(); ++i) {
    found.emplace_back(run_begins[i], i + 1 < run_begins.size() ? run_begins[i + 1] : rows());
  }
  return found;
}

Recording part_of(const Recording& recording, double from_share, double to_share) {
  Recording part = recording;
  const double begin_s = recording.time_s.front();
  const double length_s = recording.time_s.back() - begin_s;
  const auto row_at = [&](double share) {
    const double time_s = begin_s + share * length_s;
    return share >= 1.0 ? recording.rows()
                        : static_cast<std::size_t>(std::ranges::lower_bound(recording.time_s, time_s) - recording.time_s.begin());
  };
  const std::size_t first = row_at(from_share);
  const std::size_t last = std::max(first, row_at(to_share));
  const auto cut = [&](auto& values) {
    using Values = std::remove_reference_t<decltype(values)>;
    values = Values(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  cut(part.time_s);
  cut(part.line);
  for (Channel& channel : part.channels) {
    cut(channel.values);
  }
  part.run_begins = {0};
  for (const std::size_t begin : recording.run_begins) {
    if (begin > first && begin < last) {
      part.run_begins.push_back(begin - first);
    }
  }
  return part;
}

}  // namespace heatsoak
