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

}  // namespace heatsoak
