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

constexpr double kErrors_sd = 2.0;     ///< printed uncertainty in standard errors
constexpr double kLeastSaved_K = 0.5;  ///< smaller effects are not listed

std::string shown_value(double value, std::string_view unit) {
  constexpr double kShort_m = 0.1;
  if (unit == "m" && value < kShort_m) {
    return fmt::format("{} mm", base::significant(1e3 * value, 3));
  }
  return unit.empty() ? base::significant(value, 3) : fmt::format("{} {}", base::significant(value, 3), unit);
}

/// Formats a change of the robot: "jerk limit from 20 m/s³ to 10 m/s³".
std::string change_words(const select::ChangeEffect& change) {
  const std::string_view unit = select::unit_of(change.quantity);
  const double before = change.before.value();
  return fmt::format("{} from {} to {}", select::name_of(change.quantity), shown_value(before, unit),
                     shown_value(before * change.factor, unit));
}

/// Returns whether the motor needs the change to deliver the demand, or whether its effect is larger than its own scatter.
bool counts(const select::ChangeEffect& change) {
  const double error_K = change.standard_error_K.value_or(0.0);
  return change.makes_deliverable || (change.is_deliverable && change.saved_K > std::max(kLeastSaved_K, kErrors_sd * error_K));
}

/// States the most helpful change of the robot; `change` is null if none counts.
std::string best_change_words(const select::ChangeEffect* change, std::span<const select::ChangeEffect> effects,
                              const std::string& motor_id, bool is_drawn) {
  if (change != nullptr) {
    return change->makes_deliverable
               ? fmt::format("This change lets {} deliver what the duty demands: {}.", motor_id, change_words(*change))
               : fmt::format("Largest improvement for {}: {}, {:.0f} K cooler.", motor_id, change_words(*change), change->saved_K);
  }
  const select::ChangeEffect* largest = nullptr;
  for (const select::ChangeEffect& each : effects) {
    if (each.other_motor.empty() && (largest == nullptr || each.saved_K > largest->saved_K)) {
      largest = &each;
    }
  }
  if (largest == nullptr || largest->is_deliverable || !(largest->saved_K > kLeastSaved_K)) {
    return fmt::format("No change of the robot by a usual step cools {} by more than {}.", motor_id,
                       is_drawn ? "its scatter from game to game" : fmt::format("{} K", kLeastSaved_K));
  }
  return fmt::format(
      "No change of the robot by a usual step cools {} and lets it deliver what the duty demands. The largest effect has {}: {:.0f} K "
      "less.",
      motor_id, change_words(*largest), largest->saved_K);
}

/// States what another motor would change.
std::string other_motor_words(const select::ChangeEffect& other) {
  const std::string error =
      other.standard_error_K ? fmt::format(" ±{:.0f}", std::ceil(kErrors_sd * *other.standard_error_K)) : std::string();
  return fmt::format("Another motor, {}, {}{:.0f}{} K cooler (its mass and size are not compared).", other.other_motor,
                     other.makes_deliverable ? "delivers what the duty demands and is " : "is ", other.saved_K, error);
}

/// Returns the changes of the robot to list, the most helpful first: those that let the motor deliver the demand, then by saved kelvins.
std::vector<const select::ChangeEffect*> listed(std::span<const select::ChangeEffect> effects) {
  constexpr std::size_t kMost = 3;
  std::vector<const select::ChangeEffect*> shown;
  for (const select::ChangeEffect& each : effects) {
    if (each.other_motor.empty() && counts(each)) {
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
  const auto& [motor_id, passes, effects] = changes;
  constexpr std::size_t kLeastForValues = 70;
  const std::vector<const select::ChangeEffect*> shown = listed(effects);
  if (!passes) {
    document.headline.push_back({best_change_words(shown.empty() ? nullptr : shown.front(), effects, motor_id, is_drawn)});
  }
  const auto other = std::ranges::find_if(effects, [](const select::ChangeEffect& each) { return !each.other_motor.empty(); });
  if (other != effects.end() && counts(*other)) {
    document.headline.push_back({other_motor_words(*other)});
    document.add_note(Severity::background,
                      "The other motor is the one with the largest margin of the compared motors, or of the database; its mass and size "
                      "are not compared.");
  }
  if (shown.empty()) {
    return;
  }
  Table table{.title = fmt::format("Changes of the robot that help {} most", motor_id),
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
    table.rows.push_back({{std::string(select::name_of(each->quantity))},
                          {shown_value(each->before.value(), unit)},
                          {shown_value(each->before.value() * each->factor, unit)},
                          {fmt::format("{:.0f}", each->saved_K)}});
    if (is_drawn) {
      table.rows.back().push_back({each->standard_error_K ? fmt::format("{:.0f}", std::ceil(kErrors_sd * *each->standard_error_K)) : "–"});
    }
  }
  document.tables.push_back(std::move(table));
  document.add_note(
      Severity::background,
      is_drawn
          ? fmt::format("The effect of a change is the mean difference of the winding's peak over {} games with nominal values, each "
                        "with and without it; ± is two standard errors.",
                        select::kChangeGames)
          : "The effect of a change is the difference of the winding's peak between the duty with and without it, with nominal values.");
}

}  // namespace heatsoak::present
