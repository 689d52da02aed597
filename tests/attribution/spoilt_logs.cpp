#include "spoilt_logs.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/unknown.h"

namespace heatsoak::attribution::truth {
namespace {

using recording::Recording;

std::vector<double>& values_of(Recording& log, std::string_view key) {
  return std::ranges::find(log.channels, key, [](const recording::Channel& channel) { return channel.quantity.key; })->values;
}

/// Removes rows. `splits`: gaps that a reader takes for the beginning of another run.
void keep_rows(Recording& log, const std::vector<bool>& is_kept, bool splits) {
  const auto thin_out = [&](auto& values) {
    std::size_t row = 0;
    std::erase_if(values, [&](const auto&) { return !is_kept[row++]; });
  };
  thin_out(log.time_s);
  thin_out(log.line);
  for (recording::Channel& channel : log.channels) {
    thin_out(channel.values);
  }
  constexpr double kLongestGap_s = 3.0;
  for (std::size_t row = 1; splits && row < log.rows(); ++row) {
    if (log.time_s[row] - log.time_s[row - 1] > kLongestGap_s) {
      log.run_begins.push_back(row);
    }
  }
}

/// Calls `at` for `count` intervals of `length` rows at random places.
void in_intervals(const Recording& log, int count, int length, Dice& dice, const std::function<void(std::size_t)>& at) {
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::size_t>(dice.below(static_cast<int>(log.rows()) - length - 2)) + 1;
    for (std::size_t row = first; row < first + static_cast<std::size_t>(length); ++row) {
      at(row);
    }
  }
}

void lose_rows(Recording& log, Dice& dice) {
  std::vector<bool> is_kept(log.rows(), true);
  for (std::size_t row = 1; row < is_kept.size(); ++row) {
    is_kept[row] = dice.uniform(0.0, 1.0) > 0.25;
  }
  keep_rows(log, is_kept, false);
}

/// Rows only where the current changes, or after 5 s, with times that no clock divides.
void log_changes(Recording& log, Dice& dice) {
  const std::vector<double> current_A = values_of(log, "current_A");
  std::vector<bool> is_kept(log.rows(), true);
  std::size_t last = 0;
  for (std::size_t row = 1; row < is_kept.size(); ++row) {
    is_kept[row] = current_A[row] != current_A[last] || row - last >= 5;
    last = is_kept[row] ? row : last;
  }
  keep_rows(log, is_kept, false);
  for (std::size_t row = 1; row < log.rows(); ++row) {
    log.time_s[row] += dice.uniform(0.0, 0.4);
  }
}

void pause(Recording& log, Dice& dice) {
  std::vector<bool> is_kept(log.rows(), true);
  for (const int length : {6, 8, 14, 18, 40}) {
    in_intervals(log, 1, length, dice, [&](std::size_t row) { is_kept[row] = false; });
  }
  keep_rows(log, is_kept, true);
}

void lose_ambient(Recording& log, Dice& dice) {
  std::vector<double>& ambient_C = values_of(log, "ambient_C");
  for (const int length : {20, 45, 80, 100}) {
    in_intervals(log, 1, length, dice, [&](std::size_t row) { ambient_C[row] = base::kUnknown; });
  }
}

void repeat_readings(Recording& log, Dice& dice) {
  for (const char* const key : {"winding_C", "stator_C"}) {
    std::vector<double>& sensor_C = values_of(log, key);
    for (const int length : {5, 7, 12, 20, 30}) {
      in_intervals(log, 2, length, dice, [&](std::size_t row) { sensor_C[row] = sensor_C[row - 1]; });
    }
  }
}

void add_outliers(Recording& log, Dice& dice, double share, double spread_K) {
  for (const char* const key : {"winding_C", "stator_C"}) {
    for (double& sensor_C : values_of(log, key)) {
      sensor_C += dice.uniform(0.0, 1.0) < share ? spread_K * dice.normal() : 0.0;
    }
  }
}

/// Intervals of ten to thirty rows between gaps of 20 s, in the middle of the log.
void leave_pieces(Recording& log, Dice& dice) {
  std::vector<bool> is_kept(log.rows(), true);
  std::size_t row = log.rows() / 3;
  for (int piece = 0; piece < 5; ++piece) {
    for (std::size_t i = 0; i < 20; ++i) {
      is_kept[row++] = false;
    }
    row += 8 + static_cast<std::size_t>(dice.below(20));
  }
  keep_rows(log, is_kept, true);
}

}  // namespace

const std::vector<LogDefect>& log_defects() {
  static const std::vector<LogDefect> all{
      {"a quarter of the rows is lost", lose_rows},
      {"rows are written on changes", log_changes},
      {"the log pauses for 6 to 40 s", pause},
      {"ambient temperature is lost for 20 to 100 s", lose_ambient},
      {"readings repeat for 5 to 30 s", repeat_readings},
      {"3 % outliers", [](Recording& log, Dice& dice) { add_outliers(log, dice, 0.03, 4.0); }},
      {"15 % outliers", [](Recording& log, Dice& dice) { add_outliers(log, dice, 0.15, 2.0); }},
      {"short pieces between gaps", leave_pieces},
  };
  return all;
}

}  // namespace heatsoak::attribution::truth
