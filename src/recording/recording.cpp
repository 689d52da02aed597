#include "recording/recording.h"

#include <algorithm>

namespace heatsoak::recording {

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

Recording Recording::slice(std::size_t begin, std::size_t end) const {
  Recording part{name, file, motor, conditions, {}, {}, {}, {}, content, content_begin_s, blocking_of_whole, inputs};
  const auto first = static_cast<std::ptrdiff_t>(begin);
  const auto last = static_cast<std::ptrdiff_t>(end);
  part.time_s.assign(time_s.begin() + first, time_s.begin() + last);
  part.line.assign(line.begin() + first, line.begin() + last);
  for (const Channel& channel : channels) {
    part.channels.push_back({channel.quantity, {channel.values.begin() + first, channel.values.begin() + last}});
  }
  for (const std::size_t each : run_begins) {
    if (each >= begin && each < end) {
      part.run_begins.push_back(each - begin);
    }
  }
  return part;
}

Recording part_of(const Recording& recording, double from_share, double to_share) {
  const double begin_s = recording.time_s.front();
  const double length_s = recording.time_s.back() - begin_s;
  const auto row_at = [&](double share) {
    const double time_s = begin_s + share * length_s;
    return share >= 1.0 ? recording.rows()
                        : static_cast<std::size_t>(std::ranges::lower_bound(recording.time_s, time_s) - recording.time_s.begin());
  };
  const std::size_t first = row_at(from_share);
  Recording part = recording.slice(first, std::max(first, row_at(to_share)));
  if (part.run_begins.empty() || part.run_begins.front() != 0) {
    part.run_begins.insert(part.run_begins.begin(), 0);  // the part begins within a run
  }
  return part;
}

}  // namespace heatsoak::recording
