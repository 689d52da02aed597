#include "recording/write_recording.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace heatsoak::recording {

std::string to_canonical_csv(const Recording& recording) {
  std::string text = fmt::format("# from {}\n", recording.file.filename().string());
  if (!recording.motor.empty()) {
    text += fmt::format("# motor: {}\n", recording.motor);
  }
  for (const auto& [key, condition] : recording.conditions) {
    text += fmt::format("# {}: {}\n", key, condition);
  }
  text += "time_s";
  for (const Channel& channel : recording.channels) {
    text += "," + channel.quantity.key;
  }
  text += "\n";
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    fmt::format_to(std::back_inserter(text), "{}", recording.time_s[row]);
    for (const Channel& channel : recording.channels) {
      text += ',';
      if (!std::isnan(channel.values[row])) {
        fmt::format_to(std::back_inserter(text), "{}", channel.values[row]);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace heatsoak::recording
