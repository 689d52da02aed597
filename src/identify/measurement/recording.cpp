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

Recording Recording::slice(std::size_t begin, std::size_t end) const {
  Recording part{name, file, motor, conditions, {}, {}, {}, {}};
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

}  // namespace heatsoak
