#include "present/measured/log_json.h"

#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/measured/log_words.h"

namespace heatsoak::present {
namespace {

Json channels_json(const recording::DataQuality& quality) {
  Json channels = Json::array();
  for (const recording::ChannelQuality& channel : quality.channels) {
    channels.push_back({{"name", channel.quantity.key},
                        {"kind", recording::to_string(channel.quantity.kind)},
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

Json left_out_json(const recording::RecordingReport& report) {
  Json all = Json::array();
  for (const auto& [what, entry] : report.left_out) {
    Json lines = Json::array();
    for (const recording::LineRange& range : entry.lines) {
      lines.push_back({range.first, range.last});
    }
    all.push_back({{"channel", what.first.empty() ? Json(nullptr) : Json(what.first)},
                   {"reason", recording::to_string(what.second)},
                   {"count", entry.count},
                   {"lines", lines},
                   {"example", entry.example}});
  }
  return all;
}

Json clocks_json(const recording::DataQuality& quality) {
  Json clocks = Json::array();
  for (const recording::ClockOffset& offset : quality.clock_offsets) {
    clocks.push_back({{"temperature", offset.temperature},
                      {"heat_input", offset.heat_input},
                      {"delay_s", offset.delay_s ? Json(*offset.delay_s) : Json()},
                      {"standard_error_s", offset.delay_s ? Json(offset.delay_uncertainty_s) : Json()},
                      {"why_not", offset.why_not ? words_of(*offset.why_not) : ""}});
  }
  return clocks;
}

}  // namespace

Json log_json(const recording::InspectedLog& log) {
  const recording::Recording& recording = log.condensed.rows();
  const recording::RecordingReport& report = log.report;
  const recording::DataQuality& quality = log.quality;
  Json gaps = Json::array();
  for (const recording::Gap& gap : quality.gaps) {
    gaps.push_back({{"line", gap.line}, {"begin_s", gap.begin_s}, {"duration_s", gap.duration_s}});
  }
  Json result{{"file", recording.file.string()},
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
              {"suspicions", words_of(quality.suspicions)},
              {"notes", words_of(report.notes)},
              {"suggested_mapping", log.suggested_mapping.empty() ? Json() : Json(log.suggested_mapping)},
              {"thermal", {{"good", quality.thermal.is_good()}, {"lacks", words_of(quality.thermal.lacks)}}},
              {"drive", {{"good", quality.drive.is_good()}, {"lacks", words_of(quality.drive.lacks)}}}};
  return base::with_ranges(std::move(result), {{"sampling", base::kNotNegative},
                                               {"duration_s", base::kNotNegative},
                                               {"noise", base::kNotNegative},
                                               {"standard_error_s", base::kNotNegative}});
}

Json conversion_json(const recording::ConvertedLog& log, const std::string& out) {
  return {{"schema", "heatsoak.log_convert/1"},      {"file", log.file.string()},         {"out", out},
          {"rows_in_file", log.report.rows_in_file}, {"rows_kept", log.report.rows_kept}, {"channels", log.channels}};
}

}  // namespace heatsoak::present
