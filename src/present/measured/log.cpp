#include "present/measured/log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/counted.h"
#include "base/quantity.h"
#include "present/measured/log_json.h"
#include "present/measured/log_words.h"
#include "present/parameter_table.h"

namespace heatsoak::present {
namespace {

constexpr std::size_t kShownRanges = 6;
constexpr std::size_t kShownGaps = 8;
constexpr int kDigits = 4;

std::string list_of(const std::vector<recording::LineRange>& lines, std::size_t most) {
  std::vector<std::string> words;
  for (const recording::LineRange& range : lines) {
    if (words.size() == most) {
      words.push_back(fmt::format("and {} more range{}{}", lines.size() - most, lines.size() - most == 1 ? "" : "s",
                                  lines.size() == recording::LeftOut::kMostRanges ? " at least" : ""));
      break;
    }
    words.push_back(range.first == range.last ? fmt::format("{}", range.first) : fmt::format("{}-{}", range.first, range.last));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string plural(std::size_t count, std::string_view what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

std::string sampling_text(const recording::DataQuality& quality) {
  const recording::Sampling& sampling = quality.sampling;
  return fmt::format("{} s in all, a row every {} s, jitter {} s", base::significant(sampling.duration_s, kDigits),
                     base::significant(sampling.usual_period_s, 3),
                     sampling.jitter_s < 1e-6 * sampling.usual_period_s ? "0" : base::significant(sampling.jitter_s, 2));
}

std::string runs_text(const recording::DataQuality& quality) {
  if (quality.gaps.empty()) {
    return "";
  }
  std::vector<std::string> begins;
  for (std::size_t i = 0; i < std::min(kShownGaps, quality.gaps.size()); ++i) {
    begins.push_back(fmt::format("{} (after {} s)", quality.gaps[i].line, base::significant(quality.gaps[i].duration_s, 3)));
  }
  if (quality.gaps.size() > kShownGaps) {
    begins.push_back(fmt::format("and {} more", quality.runs - 1 - kShownGaps));
  }
  return fmt::format("{}; they begin at line {}", plural(quality.runs, "run"), fmt::join(begins, ", "));
}

std::string clock_text(const recording::ClockOffset& offset) {
  if (!offset.delay_s) {
    return fmt::format("{} against {}: not determinable, {}", offset.temperature, offset.heat_input,
                       offset.why_not ? words_of(*offset.why_not) : "");
  }
  return fmt::format("{} follows {} by {}{} s ± {} s (standard error); a clock offset and a sensor's lag are indistinguishable",
                     offset.temperature, offset.heat_input, *offset.delay_s > 0.0 ? "+" : "", base::significant(*offset.delay_s, 2),
                     base::significant(offset.delay_uncertainty_s, 2));
}

/// Returns the size in the largest unit of which it has at least one.
std::string size_text(std::size_t bytes) {
  constexpr double kStep = 1e3;
  const auto size = static_cast<double>(bytes);
  return size < kStep           ? fmt::format("{:.0f} B", size)
         : size < kStep * kStep ? fmt::format("{:.1f} kB", size / kStep)
                                : fmt::format("{:.1f} MB", size / (kStep * kStep));
}

Table summary_table(const std::string& title, const recording::Recording& recording, const recording::RecordingReport& report,
                    const recording::DataQuality& quality) {
  Table table = labelled_table(title);
  add_labelled(table, "rows",
               fmt::format("{} of {} kept, {}", plural(report.rows_kept, "row"), report.rows_in_file, size_text(report.file_bytes)));
  add_labelled(table, "motor", recording.motor);
  for (const auto& [key, condition] : recording.conditions) {
    add_labelled(table, key, condition);
  }
  add_labelled(table, "sampling", sampling_text(quality));
  add_labelled(table, "runs", runs_text(quality));
  for (const recording::ClockOffset& offset : quality.clock_offsets) {
    add_labelled(table, "clock", clock_text(offset));
  }
  return table;
}

Table channel_table(const recording::DataQuality& quality) {
  Table table{.columns = {{"channel", "", 0, Alignment::left},
                          {"samples", "", 2},
                          {"left out", "", 1},
                          {"lowest", "", 0},
                          {"highest", "", 0},
                          {"step", "", 4},
                          {"noise", "", 3},
                          {"kind", "", 5, Alignment::left}},
              .rows = {}};
  for (const recording::ChannelQuality& channel : quality.channels) {
    table.rows.push_back(
        {{channel.quantity.key},
         {fmt::format("{}", channel.samples)},
         {fmt::format("{}", channel.left_out), channel.left_out > 0 ? Tone::undecided : Tone::neutral},
         {base::significant(channel.low, kDigits)},
         {base::significant(channel.high, kDigits)},
         {channel.step > 0.0 ? base::significant(channel.step, 2) : "–"},
         {base::significant(channel.noise, 2)},
         {channel.quantity.key.starts_with("wheel_") ? "robot's wheel" : std::string(recording::to_string(channel.quantity.kind))}});
  }
  return table;
}

void add_fitness(Document& document, const std::string& name, const char* what, const recording::Fitness& fitness) {
  document.headline.push_back({fitness.is_good()
                                   ? fmt::format("{}: usable for {}.", name, what)
                                   : fmt::format("{}: not usable for {}: {}.", name, what, fmt::join(words_of(fitness.lacks), "; ")),
                               fitness.is_good() ? Tone::good : Tone::bad});
}

void add_log(Document& document, const recording::InspectedLog& log) {
  const recording::Recording& recording = log.condensed.rows();
  const recording::RecordingReport& report = log.report;
  const recording::DataQuality& quality = log.quality;
  // A thermal log without wheel channels gets no remark about wheels, and a drive log none about heat.
  const auto has = [&](auto is_of) { return std::ranges::any_of(recording.channels, is_of); };
  const bool has_wheels = has([](const recording::Channel& channel) { return channel.quantity.key.starts_with("wheel_"); });
  const bool has_temperatures =
      has([](const recording::Channel& channel) { return channel.quantity.kind == recording::QuantityKind::temperature; });
  const std::string name = recording.file.string();
  if (has_temperatures || !quality.drive.is_good()) {
    add_fitness(document, name, "thermal models", quality.thermal);
  }
  if (has_wheels || !quality.thermal.is_good()) {
    add_fitness(document, name, "wheel models", quality.drive);
  }
  document.tables.push_back(summary_table(recording.name, recording, report, quality));
  document.tables.push_back(channel_table(quality));
  for (const recording::Suspicion& suspicion : quality.suspicions) {
    document.add_note(Severity::warning, fmt::format("{}: {}", recording.name, words_of(suspicion)));
  }
  for (const std::string& sentence : left_out_sentences(report)) {
    document.add_note(Severity::note, fmt::format("{}: left out: {}", recording.name, sentence));
  }
  for (const recording::ReadingNote& note : report.notes) {
    document.add_note(Severity::note, fmt::format("{}: {}", recording.name, words_of(note)));
  }
  if (!log.suggested_mapping.empty()) {
    document.listings.push_back(
        {fmt::format("Mapping to start from; complete it and save it as {}.map.toml", recording.file.filename().string()),
         log.suggested_mapping});
  }
}

}  // namespace

Document logs_document(std::span<const recording::InspectedLog> logs) {
  Document document;
  Json all = Json::array();
  for (const recording::InspectedLog& log : logs) {
    add_log(document, log);
    all.push_back(log_json(log));
  }
  document.data = {{"schema", "heatsoak.log/1"}, {"logs", all}};
  return document;
}

Document conversion_document(const recording::ConvertedLog& log, const std::string& out) {
  return short_answer(fmt::format("{} of {} and {} converted.", log.report.rows_kept, base::counted(log.report.rows_in_file, "row"),
                                  base::counted(log.channels, "channel")),
                      conversion_json(log, out));
}

std::vector<std::string> left_out_sentences(const recording::RecordingReport& report) {
  std::vector<std::string> sentences;
  for (const auto& [what, entry] : report.left_out) {
    sentences.push_back(fmt::format("{}: {}; line {}{}",
                                    what.first.empty() ? plural(entry.count, "row") : plural(entry.count, "sample") + " of " + what.first,
                                    recording::to_string(what.second), list_of(entry.lines, kShownRanges),
                                    entry.example.empty() ? "" : fmt::format(" (\"{}\")", entry.example)));
  }
  return sentences;
}

std::vector<std::string> reading_words(std::span<const recording::LogReading> readings) {
  std::vector<std::string> all;
  const auto add = [&all](std::string words) {
    if (std::ranges::find(all, words) == all.end()) {
      all.push_back(std::move(words));
    }
  };
  for (const auto& [log, report] : readings) {
    for (const recording::ReadingNote& note : report.notes) {
      add(fmt::format("{}: {}", log, words_of(note)));
    }
    for (const std::string& sentence : left_out_sentences(report)) {
      add(fmt::format("{}: left out: {}", log, sentence));
    }
  }
  return all;
}

}  // namespace heatsoak::present
