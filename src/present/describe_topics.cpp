#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/confidence.h"
#include "firmware/core_diagram.h"
#include "present/description.h"
#include "present/parameter_table.h"
#include "present/topics.h"
#include "present/verdict_topic.h"

namespace heatsoak::present {
namespace {

const check::SettingText& setting_text(check::Setting setting) { return check::all_settings()[static_cast<std::size_t>(setting)]; }

void add_settings(Document& document, std::string title, const std::vector<check::Setting>& settings) {
  if (settings.empty()) {
    return;
  }
  Table table = labelled_table(std::move(title));
  for (const check::Setting setting : settings) {
    add_labelled(table, setting_text(setting).key, setting_text(setting).meaning);
  }
  document.tables.push_back(std::move(table));
}

std::string example_of(const check::ThresholdType& type) {
  std::string text = "[[check]]\nname = \"purpose of this check\"\n";
  for (const check::Setting setting : type.needs) {
    const std::string_view key = setting_text(setting).key;
    text += setting == check::Setting::temperature                                  ? fmt::format("{} = \"100 degC\"\n", key)
            : setting == check::Setting::against || setting == check::Setting::logs ? fmt::format("{} = [\"…\", \"…\"]\n", key)
                                                                                    : fmt::format("{} = \"…\"\n", key);
  }
  return text + fmt::format("[check.limits]\n{} = \"{}\"\n", type.name, type.example);
}

/// Formats the signals of a group that `readers` read: "Input: pose (m, rad), command_age_s (s)".
std::string signals_text(const firmware::SignalGroup& group, robot_core::Blocks readers) {
  std::vector<std::string> signals;
  for (const robot_core::SignalText& signal : group.signals) {
    if ((signal.to & readers) != 0) {
      signals.push_back(fmt::format("{} ({})", signal.name, signal.unit));
    }
  }
  return signals.empty() ? "" : fmt::format("{}: {}", group.carrier, fmt::join(signals, ", "));
}

}  // namespace

Document threshold_description(const check::ThresholdType& type) {
  Document document{.headline = {{fmt::format("{}: a threshold of `heatsoak check`, such as \"{}\"", type.name, type.example)}},
                    .paragraphs = {std::string(type.meaning)}};
  add_settings(document, "Needed in the check", type.needs);
  add_settings(document, "Optional in the check", type.takes);
  document.listings.push_back({"in a check file:", example_of(type)});
  return document;
}

Document command_limits_description() {
  Document document{
      .headline = {{"command: a check of `heatsoak check` with limits on any number of a command's JSON answer"}},
      .paragraphs = {
          "The name of a number is the list of keys to it, joined by \".\"; `heatsoak COMMAND … --json -` shows them. An element "
          "of a list has the value of its first key, or its place from 0. \"*\" is every element or key; the worst number "
          "counts.",
          fmt::format("The unit is that in which the name ends, or of the \"unit\" beside the number, or of the key around it. Of a number "
                      "with a {} interval beside it, the worse end is compared. A list limits both sides. A number that is missing or "
                      "null fails its limit. Exception: a null whose key is in the list \"never\" beside it is a time that never "
                      "comes, longer than every limit.",
                      base::level_text(base::kInterval_share)),
          "The command runs in the folder of the check file and writes no file. Mistakes in its options, ids and files are reported with "
          "those of the check file, before anything is computed. The key \"ranges\" of an answer gives the lowest and highest possible "
          "value of numbers by their names; --update writes no limit that cannot fail."}};
  document.listings.push_back({"in a check file:",
                               "[[check]]\n"
                               "name = \"purpose of this check\"\n"
                               "command = \"derate --robot roboteam_twente_v2024 --motor maxon_ecx_flat_42m_24v\"\n"
                               "[check.limits]\n"
                               "heat_reserve_ratio = \"at most 1.9\"\n"
                               "\"guarantee.winding_peak_C.*\" = \"at most 150 degC\"\n"});
  return document;
}

namespace {

Table undecided_table() {
  Table table = labelled_table("Undecided verdicts");
  for (const UndecidedDetail& each : undecided_details()) {
    add_labelled(table, each.label, each.words);
  }
  return table;
}

}  // namespace

Document verdict_description() {
  Document document{.headline = {{fmt::format(
                        "verdict: the result of `evaluate` for a motor on a duty. From the best to the worst: pass; marginal (more than "
                        "{:.0f} % of the samples exceed a limit or miss the demand); fail (a limit is exceeded); infeasible (voltage or "
                        "current is too low). Undecided: more samples are needed.",
                        100.0 * select::kMarginalProbability)}},
                    .paragraphs = {}};
  Table table = labelled_table("");
  for (const VerdictMeaning& each : verdict_meanings()) {
    add_labelled(table, select::to_string(each.verdict), each.meaning);
  }
  add_labelled(table, "undecided", undecided_meaning());
  document.tables.push_back(std::move(table));
  document.tables.push_back(undecided_table());
  document.add_note(
      Severity::note,
      "Without --closed-loop the robot follows the plan exactly. If the plan needs more grip than the wheels have in 1 % of the "
      "time or more, the answer says so in its first lines: only a closed loop decides whether the robot can drive it.");
  document.add_note(Severity::note,
                    "With --closed-loop: fail if the first game or more than half of the games exceed a limit; infeasible if a game was "
                    "not driven; marginal if any other game exceeds a limit.");
  return document;
}

std::optional<Document> one_verdict_description(std::string_view name) {
  std::vector<std::pair<std::string_view, std::string>> all{{"undecided", undecided_meaning()}};
  for (const VerdictMeaning& each : verdict_meanings()) {
    all.emplace_back(select::to_string(each.verdict), each.meaning);
  }
  const auto found = std::ranges::find(all, name, [](const auto& each) { return each.first; });
  if (found == all.end()) {
    return std::nullopt;
  }
  Document document{.headline = {{fmt::format("{}: a verdict of `evaluate` on a motor", name)}}, .paragraphs = {found->second}};
  if (name == "undecided") {
    document.tables.push_back(undecided_table());
  }
  document.add_note(Severity::scope, "`heatsoak describe verdict` explains all verdicts.");
  return described(std::move(document), {{"kind", "verdict"}, {"id", name}, {"meaning", found->second}});
}

Document core_description() {
  Document document{
      .headline = {{"robot_core: the drive core, one control step of a robot on three or four omni wheels, in simulation and in firmware"}},
      .paragraphs = {
          "One call of robot_core::step() runs these blocks in this order; sources in robot_core/. `heatsoak describe robot_core "
          "--diagram core.svg` draws them, `heatsoak generate core` writes the core for a robot."}};
  const std::vector<firmware::SignalGroup> groups = firmware::signal_groups();
  for (const robot_core::BlockText& block : robot_core::kBlocks) {
    Table table = labelled_table(
        fmt::format("{} {}, {}: {}() in {}", block.number, block.title, firmware::rate_words(block.rate), block.function, block.files));
    add_labelled(table, "task", block.task);
    for (const firmware::SignalGroup& group : groups) {
      add_labelled(table, "reads", signals_text(group, robot_core::only(block.block)));
    }
    for (const firmware::SignalGroup& group : groups) {
      add_labelled(table, "writes", group.from == block.block ? signals_text(group, ~0U) : "");
    }
    document.tables.push_back(std::move(table));
  }
  return document;
}

}  // namespace heatsoak::present
