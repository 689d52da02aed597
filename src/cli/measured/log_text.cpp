#include "cli/measured/log_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/quantity.h"

namespace heatsoak {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownRanges = 6;
constexpr std::size_t kShownGaps = 8;
constexpr int kDigits = 4;

std::string list_of(const std::vector<LineRange>& lines, std::size_t most) {
  std::vector<std::string> words;
  for (const LineRange& range : lines) {
    if (words.size() == most) {
      words.push_back(fmt::format("and {} more range{}{}", lines.size() - most, lines.size() - most == 1 ? "" : "s",
                                  lines.size() == LeftOut::kMostRanges ? " at least" : ""));
      break;
    }
    words.push_back(range.first == range.last ? fmt::format("{}", range.first) : fmt::format("{}-{}", range.first, range.last));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string plural(std::size_t count, std::string_view what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

std::string head(const Recording& recording, const RecordingReport& report) {
  std::string text = fmt::format("{}: {} of {} kept, {:.1f} MB", recording.file.string(), plural(report.rows_kept, "row"),
                                 report.rows_in_file, static_cast<double>(report.file_bytes) / 1e6);
  text += recording.motor.empty() ? "" : fmt::format("; motor {}", recording.motor);
  for (const auto& [key, condition] : recording.conditions) {
    text += fmt::format("; {}: {}", key, condition);
  }
  return text + "\n";
}

std::string sampling_text(const DataQuality& quality) {
  const Sampling& sampling = quality.sampling;
  std::string text = fmt::format("sampling: {} s in all, a row every {} s, jitter {} s\n", significant(sampling.duration_s, kDigits),
                                 significant(sampling.usual_period_s, 3),
                                 sampling.jitter_s < 1e-6 * sampling.usual_period_s ? "0" : significant(sampling.jitter_s, 2));
  if (quality.gaps.empty()) {
    return text;
  }
  text += fmt::format("runs: {}; they begin at line", plural(quality.runs, "run"));
  for (std::size_t i = 0; i < quality.gaps.size(); ++i) {
    if (i == kShownGaps) {
      text += fmt::format(" and {} more", quality.runs - 1 - i);
      break;
    }
    text += fmt::format("{} {} (after {} s)", i > 0 ? "," : "", quality.gaps[i].line, significant(quality.gaps[i].duration_s, 3));
  }
  return text + "\n";
}

std::string channel_table(const DataQuality& quality) {
  std::size_t width = 8;
  for (const ChannelQuality& channel : quality.channels) {
    width = std::max(width, channel.quantity.key.size());
  }
  std::string text = fmt::format("{:{}} {:>9} {:>9} {:>10} {:>10} {:>10} {:>10}\n", "channel", width, "samples", "left out", "lowest",
                                 "highest", "step", "noise");
  for (const ChannelQuality& channel : quality.channels) {
    text += fmt::format("{:{}} {:9} {:9} {:>10} {:>10} {:>10} {:>10}  {}\n", channel.quantity.key, width, channel.samples, channel.left_out,
                        significant(channel.low, kDigits), significant(channel.high, kDigits),
                        channel.step > 0.0 ? significant(channel.step, 2) : "-", significant(channel.noise, 2),
                        channel.quantity.key.starts_with("wheel_") ? "of a robot's wheel" : to_string(channel.quantity.kind));
  }
  return text;
}

std::string clock_text(const ClockOffset& offset) {
  if (!offset.delay_s) {
    return fmt::format("clock: {} against {}: not determinable, {}\n", offset.temperature, offset.heat_input, offset.why_not);
  }
  return fmt::format("clock: {} follows {} by {:+.2g} s ± {} s (standard error); a clock offset and a sensor's lag are indistinguishable\n",
                     offset.temperature, offset.heat_input, *offset.delay_s, significant(offset.delay_uncertainty_s, 2));
}

std::string fitness_text(const char* what, const Fitness& fitness) {
  return fitness.is_good() ? fmt::format("{}: yes\n", what) : fmt::format("{}: no, {}\n", what, fmt::join(fitness.lacks, "; "));
}

Json channels_json(const DataQuality& quality) {
  Json channels = Json::array();
  for (const ChannelQuality& channel : quality.channels) {
    channels.push_back({{"name", channel.quantity.key},
                        {"kind", to_string(channel.quantity.kind)},
                        {"unit", channel.quantity.unit},
                        {"samples", channel.samples},
                        {"left_out", channel.left_out},
                        {"lowest", channel.low},
                        {"highest", channel.high},
                        {"step", channel.step > 0.0 ? Json(channel.step) : Json(nullptr)},
                        {"noise", channel.noise}});
  }
  return channels;
}

Json left_out_json(const RecordingReport& report) {
  Json all = Json::array();
  for (const auto& [what, entry] : report.left_out) {
    Json lines = Json::array();
    for (const LineRange& range : entry.lines) {
      lines.push_back({range.first, range.last});
    }
    all.push_back({{"channel", what.first.empty() ? Json(nullptr) : Json(what.first)},
                   {"reason", to_string(what.second)},
                   {"count", entry.count},
                   {"lines", lines},
                   {"example", entry.example}});
  }
  return all;
}

Json clocks_json(const DataQuality& quality) {
  Json clocks = Json::array();
  for (const ClockOffset& offset : quality.clock_offsets) {
    clocks.push_back({{"temperature", offset.temperature},
                      {"heat_input", offset.heat_input},
                      {"delay_s", offset.delay_s ? Json(*offset.delay_s) : Json()},
                      {"standard_error_s", offset.delay_s ? Json(offset.delay_uncertainty_s) : Json()},
                      {"why_not", offset.why_not}});
  }
  return clocks;
}

}  // namespace

std::vector<std::string> left_out_sentences(const RecordingReport& report) {
  std::vector<std::string> sentences;
  for (const auto& [what, entry] : report.left_out) {
    sentences.push_back(fmt::format(
        "{}: {}; line {}{}", what.first.empty() ? plural(entry.count, "row") : plural(entry.count, "sample") + " of " + what.first,
        to_string(what.second), list_of(entry.lines, kShownRanges), entry.example.empty() ? "" : fmt::format(" (\"{}\")", entry.example)));
  }
  return sentences;
}

std::string log_text(const Recording& recording, const RecordingReport& report, const DataQuality& quality) {
  std::string text = head(recording, report) + sampling_text(quality) + channel_table(quality);
  for (const std::string& sentence : left_out_sentences(report)) {
    text += fmt::format("left out: {}\n", sentence);
  }
  for (const ClockOffset& offset : quality.clock_offsets) {
    text += clock_text(offset);
  }
  for (const std::string& suspicion : quality.suspicions) {
    text += "suspicious: " + suspicion + "\n";
  }
  for (const std::string& note : report.notes) {
    text += "note: " + note + "\n";
  }
  // A thermal log without wheel channels gets no remark about wheels, and a drive log none about heat.
  const auto has = [&](auto is_of) { return std::ranges::any_of(recording.channels, is_of); };
  const bool has_wheels = has([](const Channel& channel) { return channel.quantity.key.starts_with("wheel_"); });
  const bool has_temperatures = has([](const Channel& channel) { return channel.quantity.kind == QuantityKind::temperature; });
  text += has_temperatures || !quality.drive.is_good() ? fitness_text("usable for thermal models", quality.thermal) : "";
  text += has_wheels || !quality.thermal.is_good() ? fitness_text("usable for wheel models", quality.drive) : "";
  return text;
}

Json log_json(const Recording& recording, const RecordingReport& report, const DataQuality& quality) {
  Json gaps = Json::array();
  for (const Gap& gap : quality.gaps) {
    gaps.push_back({{"line", gap.line}, {"begin_s", gap.begin_s}, {"duration_s", gap.duration_s}});
  }
  return {{"file", recording.file.string()},
          {"motor", recording.motor},
          {"conditions", recording.conditions},
          {"rows_in_file", report.rows_in_file},
          {"rows_kept", report.rows_kept},
          {"sampling",
           {{"duration_s", quality.sampling.duration_s},
            {"usual_period_s", quality.sampling.usual_period_s},
            {"jitter_s", quality.sampling.jitter_s},
            {"longest_gap_s", quality.sampling.longest_gap_s}}},
          {"runs", quality.runs},
          {"gaps", gaps},
          {"channels", channels_json(quality)},
          {"left_out", left_out_json(report)},
          {"clock_offsets", clocks_json(quality)},
          {"suspicions", quality.suspicions},
          {"notes", report.notes},
          {"thermal", {{"good", quality.thermal.is_good()}, {"lacks", quality.thermal.lacks}}},
          {"drive", {{"good", quality.drive.is_good()}, {"lacks", quality.drive.lacks}}}};
}

}  // namespace heatsoak
