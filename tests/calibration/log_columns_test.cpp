// Two curves over two columns of a log. The steady temperatures follow from Ohm's law of heat: rise = (sum of the heats) · resistance.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "calibration/forecast/prediction.h"
#include "motor/motor.h"
#include "motor/write_motor.h"
#include "study.h"

namespace heatsoak::calibration::study {
namespace {

/// Returns a curve of heat into the stator: 0 W where the column is 0, `most_W` where it is 1.
std::string curve_of(const std::string& column, double most_W) {
  std::string text = "\n[effects." + column + "_heat]\ntype = \"tabulated\"\ndriver = \"column\"\nform = \"heat\"\ncolumn = \"" + column +
                     "\"\nhot = \"stator\"\n";
  const auto number = [&](const std::string& key, double value, const std::string& unit) {
    text += key + " = { value = \"" + std::to_string(value) + unit + R"(", origin = "measured", source = "s" })" + "\n";
  };
  number("first_knot", 0.0, "");
  number("last_knot", 1.0, "");
  for (int knot = 0; knot < 7; ++knot) {
    number("value_" + std::to_string(knot + 1), most_W * knot / 6.0, " W");
  }
  return text;
}

constexpr double kHalfStep_K = 0.02;

recording::Recording steady_log(double stator_C, double ambient_C, double fan_ratio, double pump_ratio) {
  recording::Recording log;
  log.name = "steady";
  log.file = "steady.csv";
  log.run_begins = {0};
  const std::vector<std::pair<std::string, double>> cells{{"winding_C", stator_C}, {"stator_C", stator_C},   {"ambient_C", ambient_C},
                                                          {"current_A", 0.0},      {"fan_ratio", fan_ratio}, {"pump_ratio", pump_ratio}};
  for (int row = 0; row < 3600; ++row) {
    log.time_s.push_back(row);
    log.line.push_back(row + 2);
  }
  for (const auto& [key, value] : cells) {
    recording::Channel& channel =
        log.channels.emplace_back(recording::quantity_named(key).value(), std::vector<double>(log.time_s.size(), value));
    // A converter between two steps: a reading that never changes counts as stuck.
    for (std::size_t row = 0; key.ends_with("_C") && row < channel.values.size(); ++row) {
      channel.values[row] += row % 2 == 0 ? kHalfStep_K : -kHalfStep_K;
    }
  }
  return log;
}

TEST(LogColumns, two_curves_read_their_own_columns) {
  const Folder folder;
  const motor::Motor plain = Sheet{}.motor(folder);
  const std::filesystem::path file = folder.path() / "two_curves.toml";
  std::ofstream(file) << motor::to_toml(plain) << curve_of("pump_ratio", 3.0) << curve_of("fan_ratio", 6.0);
  const motor::Motor motor = motor::read_motor(file);
  constexpr double kAmbient_C = 20.0;
  const double rise_K = motor.nominal.thermal_resistance_stator_ambient_K_per_W * (6.0 * 0.5 + 3.0 / 3.0);
  const auto error_K = [&](double fan_ratio, double pump_ratio) {
    const std::vector<recording::Recording> logs{steady_log(kAmbient_C + rise_K, kAmbient_C, fan_ratio, pump_ratio)};
    const Prediction found = predict(motor, logs, {});
    double most_K = 0.0;
    for (const PredictedSignal& signal : found.runs.at(0).signals) {
      most_K = std::max(most_K, signal.max_abs_K);
    }
    return most_K;
  };
  EXPECT_LT(error_K(0.5, 1.0 / 3.0), 0.01 + 2.0 * kHalfStep_K);
  EXPECT_GT(error_K(1.0 / 3.0, 0.5), 0.05 * rise_K) << "exchanged columns give 3.5 W instead of 4 W";
}

/// A log without one of the columns, in whole or for more than 60 s, is named together with the column.
TEST(LogColumns, a_column_that_a_log_lacks_is_reported) {
  const Folder folder;
  const std::filesystem::path file = folder.path() / "curve.toml";
  std::ofstream(file) << motor::to_toml(Sheet{}.motor(folder)) << curve_of("fan_ratio", 6.0);
  const motor::Motor motor = motor::read_motor(file);
  const auto notes_on = [&](std::size_t first_blank, std::size_t blank_rows) {
    recording::Recording log = steady_log(30.0, 20.0, 0.5, 0.5);
    for (recording::Channel& channel : log.channels) {
      for (std::size_t row = first_blank; channel.quantity.key == "fan_ratio" && row < first_blank + blank_rows; ++row) {
        channel.values[row] = std::nan("");
      }
    }
    std::vector<estimation::RunNote> notes;
    for (const PredictionNote& note : predict(motor, std::vector{log}, {}).notes) {
      if (const auto* const of_run = std::get_if<estimation::RunNote>(&note)) {
        notes.push_back(*of_run);
      }
    }
    return notes;
  };
  EXPECT_TRUE(notes_on(100, 50).empty());
  const std::vector<estimation::RunNote> partly = notes_on(100, 80);
  ASSERT_EQ(partly.size(), 1U);
  const auto& blank = std::get<estimation::ColumnBlank>(partly[0]);
  EXPECT_EQ(blank.recording, "steady");
  EXPECT_EQ(blank.column, "fan_ratio");
  EXPECT_NEAR(blank.blank_s, 80.0, 1e-9);
  EXPECT_TRUE(blank.is_held);
  const std::vector<estimation::RunNote> wholly = notes_on(0, 3600);
  ASSERT_EQ(wholly.size(), 1U);
  const auto& lacking = std::get<estimation::ColumnsLacking>(wholly[0]);
  EXPECT_EQ(lacking.recording, "steady");
  EXPECT_EQ(lacking.columns, std::vector<std::string>{"fan_ratio"});
}

}  // namespace
}  // namespace heatsoak::calibration::study
