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

double usual_period_s(const Recording& recording) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < recording.rows(); ++i) {
    steps_s.push_back(recording.time_s[i] - recording.time_s[i - 1]);
  }
  if (steps_s.empty()) {
    return 0.0;
  }
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::ranges::nth_element(steps_s, middle);
  return *middle;
}

}  // namespace heatsoak
