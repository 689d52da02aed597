#include "present/changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "base/quantity.h"

namespace heatsoak::present {
namespace {

constexpr double kLeastSaved_K = 0.5;  ///< smaller effects are not listed

std::string shown_value(double value, std::string_view unit) {
  return unit.empty() ? base::significant(value, 3) : fmt::format("{} {}", base::significant(value, 3), unit);
}

/// Formats a change: "jerk limit from 20 m/s³ to 10 m/s³", "motor to nanotec_df45l024048_a2".
std::string change_words(const select::ChangeEffect& change) {
  return change.other_motor.empty() ? fmt::format("{} from {} to {}", select::name_of(change.quantity),
                                                  shown_value(change.before, select::unit_of(change.quantity)),
                                                  shown_value(change.before * change.factor, select::unit_of(change.quantity)))
                                    : fmt::format("motor to {}", change.other_motor);
}

/// Returns whether the motor needs the change to deliver the demand, or whether its effect is larger than its own scatter.
bool counts(const select::ChangeEffect& change) {
  const double error_K = change.standard_error_K.value_or(0.0);
  return change.makes_deliverable || (change.is_deliverable && change.saved_K > std::max(kLeastSaved_K, 2.0 * error_K));
}

/// States the most helpful change; `change` is null if none counts.
std::string best_change_words(const select::ChangeEffect* change, std::span<const select::ChangeEffect> effects,
                              const std::string& motor_id, bool is_drawn) {
  if (change != nullptr) {
    return change->makes_deliverable
               ? fmt::format("This change lets {} deliver what the duty demands: {}.", change->other_motor.empty() ? motor_id : "the robot",
                             change_words(*change))
               : fmt::format("Largest improvement for {}: {}, {:.0f} K cooler{}.", motor_id, change_words(*change), change->saved_K,
                             change->other_motor.empty() ? "" : " (its mass and size are not compared)");
  }
  const auto largest = std::ranges::max_element(effects, {}, &select::ChangeEffect::saved_K);
  if (largest == effects.end() || largest->is_deliverable || !(largest->saved_K > kLeastSaved_K)) {
    return fmt::format("No change of the robot by a usual step cools {} by more than {}.", motor_id,
                       is_drawn ? "its scatter from game to game" : fmt::format("{} K", kLeastSaved_K));
  }
  return fmt::format(
      "No change of the robot by a usual step cools {} and lets it deliver what the duty demands. The largest effect has {}: {:.0f} K "
      "less.",
      motor_id, change_words(*largest), largest->saved_K);
}

/// Returns the changes to list, the most helpful first: those that let the motor deliver the demand, then by saved kelvins.
std::vector<const select::ChangeEffect*> listed(std::span<const select::ChangeEffect> effects) {
  constexpr std::size_t kMost = 3;
  std::vector<const select::ChangeEffect*> shown;
  for (const select::ChangeEffect& each : effects) {
    if (counts(each)) {
      shown.push_back(&each);
    }
  }
  std::ranges::stable_sort(shown, std::ranges::greater(),
                           [](const select::ChangeEffect* each) { return std::pair(each->makes_deliverable, each->saved_K); });
  shown.resize(std::min(shown.size(), kMost));
  return shown;
}

}  // namespace

void add_changes(Document& document, const simulate::SuggestedChanges& changes, bool is_drawn) {
  const auto& [motor_id, effects] = changes;
  constexpr std::size_t kLeastForValues = 70;
  const std::vector<const select::ChangeEffect*> shown = listed(effects);
  document.headline.push_back({best_change_words(shown.empty() ? nullptr : shown.front(), effects, motor_id, is_drawn)});
  if (shown.empty()) {
    return;
  }
  Table table{.title = fmt::format("Changes that help {} most", motor_id),
              .columns = {{"change", "", 0, Alignment::left},
                          {"from", "", 1, Alignment::right, kLeastForValues},
                          {"to", "", 1, Alignment::right, kLeastForValues},
                          {"saves", "K", 0}},
              .rows = {}};
  if (is_drawn) {
    table.columns.push_back({"±", "K", 2});
  }
  for (const select::ChangeEffect* each : shown) {
    const std::string_view unit = select::unit_of(each->quantity);
    const bool is_value = each->other_motor.empty();
    table.rows.push_back({{is_value ? std::string(select::name_of(each->quantity)) : fmt::format("motor {}", each->other_motor)},
                          {is_value ? shown_value(each->before, unit) : ""},
                          {is_value ? shown_value(each->before * each->factor, unit) : ""},
                          {fmt::format("{:.0f}", each->saved_K)}});
    if (is_drawn) {
      table.rows.back().push_back({each->standard_error_K ? fmt::format("{:.0f}", std::ceil(2.0 * *each->standard_error_K)) : "–"});
    }
  }
  document.tables.push_back(std::move(table));
  document.add_note(Severity::background,
                    is_drawn ? fmt::format("Changes: mean of {} games with nominal values, each driven with and without the change; ± is "
                                           "two standard errors.",
                                           select::kChangeGames)
                             : "Changes: the duty with nominal values, once with and once without the change.");
  if (std::ranges::any_of(shown, [](const select::ChangeEffect* each) { return !each->other_motor.empty(); })) {
    document.add_note(Severity::background,
                      "The other motor is the one with the largest margin of the compared motors, or of the database; its mass and size "
                      "are not compared.");
  }
}

}  // namespace heatsoak::present
