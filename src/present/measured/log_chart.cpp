#include "present/measured/log_chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "base/quantity.h"

namespace heatsoak::present {
namespace {

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
constexpr int kLeftOutColor = 6;                 ///< vermilion
constexpr std::size_t kCurveColors = 6;          ///< colours before it in the palette
constexpr double kNarrowestMark_share = 0.0015;  ///< share of the width, so that a single sample is visible

struct TimeScale {
  double factor = 1.0;
  const char* label = "time / s";
};

TimeScale scale_for(double duration_s) {
  if (duration_s > 3.0 * 3600.0) {
    return {1.0 / 3600.0, "time / h"};
  }
  return duration_s > 300.0 ? TimeScale{1.0 / 60.0, "time / min"} : TimeScale{};
}

/// Channels that share axes: all temperatures, the speeds of all wheels, …
struct ChannelGroup {
  std::string title;
  std::string y_label;
  bool is_of_wheels = false;  ///< each wheel has its colour and is named once
  std::vector<std::size_t> channels;
};

std::string stem_of(const std::string& key) {
  const std::size_t end = key.find_last_not_of("0123456789");
  return end != std::string::npos && end + 1 < key.size() && key[end] == '_' ? key.substr(0, end) : key;
}

/// Returns the wheel index, from 0, of a key such as "…_1".
std::size_t wheel_of(const std::string& key) {
  std::size_t number = 1;
  std::from_chars(key.data() + stem_of(key).size() + 1, key.data() + key.size(), number);
  return std::max<std::size_t>(number, 1) - 1;
}

bool is_temperature(const recording::Channel& channel) {
  return channel.quantity.kind == recording::QuantityKind::temperature || channel.quantity.kind == recording::QuantityKind::surroundings;
}

/// Returns quantity and unit: "current / A"; the unit alone if its quantity has no name here.
std::string axis_title(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kNames{{{"degC", "temperature"},
                                                                                  {"A", "current"},
                                                                                  {"V", "voltage"},
                                                                                  {"W", "power"},
                                                                                  {"Nm", "torque"},
                                                                                  {"rad/s", "speed"},
                                                                                  {"m/s", "speed"},
                                                                                  {"rad/s2", "acceleration"},
                                                                                  {"rad", "angle"},
                                                                                  {"h", "time"}}};
  const auto found = std::ranges::find(kNames, unit, &std::pair<std::string_view, std::string_view>::first);
  if (unit.empty()) {
    return "ratio";
  }
  const std::string shown = base::unit_for_display(unit);
  return found == kNames.end() ? shown : fmt::format("{} / {}", found->second, shown);
}

std::vector<ChannelGroup> groups_of(const recording::Recording& recording) {
  std::vector<ChannelGroup> groups;
  std::vector<std::string> names;
  for (const recording::QuantityKind kind : {recording::QuantityKind::temperature, recording::QuantityKind::surroundings,
                                             recording::QuantityKind::heat_input, recording::QuantityKind::signal}) {
    for (std::size_t place = 0; place < recording.channels.size(); ++place) {
      const recording::Channel& channel = recording.channels[place];
      if (channel.quantity.kind != kind) {
        continue;
      }
      const std::string stem = stem_of(channel.quantity.key);
      const bool is_wheel = stem != channel.quantity.key;
      const std::string name = is_temperature(channel) ? "temperature"
                               : is_wheel              ? stem
                                                       : channel.quantity.unit + recording::to_string(kind).data();
      const auto found = std::ranges::find(names, name);
      if (found == names.end()) {
        names.push_back(name);
        groups.push_back({is_temperature(channel) ? "temperatures"
                          : is_wheel              ? stem
                                                  : "",
                          axis_title(channel.quantity.unit),
                          is_wheel,
                          {place}});
      } else {
        groups[static_cast<std::size_t>(found - names.begin())].channels.push_back(place);
      }
    }
  }
  for (ChannelGroup& group : groups) {
    if (group.title.empty()) {
      std::vector<std::string> keys;
      for (const std::size_t place : group.channels) {
        keys.push_back(recording.channels[place].quantity.key);
      }
      group.title = fmt::format("{}", fmt::join(keys, ", "));
    }
  }
  return groups;
}

class LogChart {
 public:
  LogChart(const recording::CondensedRecording& condensed, const recording::DataQuality& quality, const recording::RecordingReport& report)
      : condensed_(condensed),
        recording_(condensed.rows()),
        quality_(quality),
        report_(report),
        duration_s_(quality.sampling.duration_s),
        scale_(scale_for(duration_s_)) {}

  report::Chart draw() const {
    report::Chart chart;
    chart.title = recording_.name + (recording_.motor.empty() ? "" : ", motor " + recording_.motor);
    chart.subtitle = subtitle();
    chart.x_label = scale_.label;
    chart.panel_height_px = 220;
    std::set<std::string> named;
    for (const ChannelGroup& group : groups_of(recording_)) {
      chart.panels.push_back(panel(group, named));
    }
    return chart;
  }

 private:
  [[nodiscard]] std::string subtitle() const {
    std::string text;
    for (const auto& [key, condition] : recording_.conditions) {
      text += fmt::format("{}: {}; ", key, condition);
    }
    return text + fmt::format("{} of {} rows in {} run{}{}", report_.rows_kept, report_.rows_in_file, quality_.runs,
                              quality_.runs == 1 ? "" : "s", report_.left_out.empty() ? "" : "; shaded: left out");
  }

  report::ChartPanel panel(const ChannelGroup& group, std::set<std::string>& named) const {
    report::ChartPanel result{.title = group.title, .y_label = group.y_label, .curves = {}, .bands = {}, .levels = {}};
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < group.channels.size(); ++i) {
      const std::size_t place = group.channels[i];
      const std::string& key = recording_.channels[place].quantity.key;
      const std::size_t wheel = group.is_of_wheels ? wheel_of(key) : i;
      const std::string name = group.is_of_wheels ? fmt::format("wheel {}", wheel + 1) : key;
      const bool is_listed = (group.is_of_wheels || group.channels.size() > 1) && named.insert(name).second;
      result.curves.push_back(curve(place, is_listed ? name : "", static_cast<int>(wheel % kCurveColors), wheel >= kCurveColors));
      low = std::min(low, quality_.channels[place].low);
      high = std::max(high, quality_.channels[place].high);
    }
    const double margin = high > low ? 0.0 : 0.5 * std::max(std::abs(high), 1.0);
    low -= margin;
    high += margin;
    for (const auto& [begin, end] : marks(group)) {
      result.bands.push_back({named.insert("left out").second ? "left out" : "", {begin, end}, {low, low}, {high, high}, kLeftOutColor});
    }
    return result;
  }

  [[nodiscard]] report::ChartCurve curve(std::size_t place, const std::string& name, int color, bool dashed) const {
    report::ChartCurve result{.name = name, .color_index = color, .dashed = dashed, .has_ripple = true};
    const std::vector<double>& low = condensed_.low(place);
    const std::vector<double>& high = condensed_.high(place);
    const auto add = [&](std::size_t row, double value) {
      result.x.push_back(recording_.time_s[row] * scale_.factor);
      result.y.push_back(value);
    };
    for (const auto& [begin, end] : recording_.runs()) {
      for (std::size_t row = begin; row < end; ++row) {
        add(row, low[row]);
        if (high[row] > low[row]) {
          add(row, high[row]);
        }
      }
      add(end - 1, kBreak);
    }
    return result;
  }

  /// Returns the merged time ranges of rejected rows and of rejected samples of the group's channels.
  [[nodiscard]] std::vector<std::pair<double, double>> marks(const ChannelGroup& group) const {
    std::vector<std::pair<double, double>> found;
    for (const auto& [what, entry] : report_.left_out) {
      const bool is_here = what.first.empty() || std::ranges::any_of(group.channels, [this, &key = what.first](std::size_t place) {
                             return recording_.channels[place].quantity.key == key;
                           });
      for (const recording::LineRange& lines : is_here ? entry.lines : std::vector<recording::LineRange>{}) {
        const double begin_s = time_of(lines.first);
        const double width_s = std::max(time_of(lines.last + 1) - begin_s, kNarrowestMark_share * duration_s_);
        found.emplace_back(begin_s * scale_.factor, (begin_s + width_s) * scale_.factor);
      }
    }
    std::ranges::sort(found);
    std::vector<std::pair<double, double>> merged;
    for (const auto& each : found) {
      if (merged.empty() || each.first > merged.back().second) {
        merged.push_back(each);
      } else {
        merged.back().second = std::max(merged.back().second, each.second);
      }
    }
    return merged;
  }
  /// Returns the time of the first kept row at or after this line.
  [[nodiscard]] double time_of(int line) const {
    const auto row = std::ranges::lower_bound(recording_.line, line);
    return row == recording_.line.end() ? recording_.time_s.back()
                                        : recording_.time_s[static_cast<std::size_t>(row - recording_.line.begin())];
  }

  const recording::CondensedRecording& condensed_;
  const recording::Recording& recording_;
  const recording::DataQuality& quality_;
  const recording::RecordingReport& report_;
  double duration_s_;
  TimeScale scale_;
};

}  // namespace

report::Chart log_chart(const recording::InspectedLog& log) { return LogChart(log.condensed, log.quality, log.report).draw(); }

}  // namespace heatsoak::present
