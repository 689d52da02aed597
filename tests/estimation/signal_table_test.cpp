// The table of quantities of the operating point, and what follows from it for logs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "estimation/log_rows.h"
#include "estimation/measured_run.h"
#include "estimation/thresholds.h"
#include "recording/quantities.h"
#include "thermal/operating_point.h"

namespace heatsoak::estimation {
namespace {

std::vector<thermal::Signal> every_signal() {
  std::vector<thermal::Signal> all;
  for (std::size_t i = 0; i < thermal::kSignalCount; ++i) {
    all.push_back(static_cast<thermal::Signal>(i));
  }
  return all;
}

TEST(SignalTable, EverySignalHasOneLogColumnThatLogsKnow) {
  for (const thermal::Signal signal : every_signal()) {
    std::vector<std::string> columns;
    for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
      if (each.signal == signal && !each.column.empty()) {
        columns.emplace_back(each.column);
      }
    }
    ASSERT_EQ(columns.size(), 1U) << static_cast<int>(signal);
    EXPECT_FALSE(thermal::quantity_of(signal).lacking.empty()) << columns.front();
    EXPECT_TRUE(recording::quantity_named(columns.front())) << columns.front();
  }
}

TEST(SignalTable, ColumnsThatAreReadDirectlyHaveTheUnitOfTheLog) {
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    if (each.from != thermal::FromColumn::computed) {
      EXPECT_EQ(recording::quantity_named(each.column).value().unit, each.unit) << each.name;
    }
  }
}

TEST(SignalTable, NamesAreUniqueAndInputSignalsComplete) {
  std::set<std::string_view> names;
  std::size_t rows = 0;
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    names.insert(each.name);
    ++rows;
    EXPECT_EQ(thermal::quantity_row(each.name), rows - 1);
    if (each.curve_place) {
      EXPECT_TRUE(each.signal) << each.name;
      EXPECT_FALSE(each.curve_meaning.empty()) << each.name;
    }
  }
  EXPECT_EQ(names.size(), rows);
  EXPECT_EQ(thermal::quantity_row("no such quantity"), thermal::kQuantityCount);
}

TEST(SignalTable, EachMemberHasItsOwnRow) {
  thermal::OperatingPoint<double> at;
  thermal::for_each_quantity([](double& value) { value = 0.0; }, at);
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    EXPECT_EQ(at.*each.value, 0.0) << each.name << " is a second row of its member";
    at.*each.value = 1.0;
  }
}

/// A log with this column alone: the signal is there, and the row has its value.
TEST(SignalTable, ColumnsThatAreReadDirectlyReachTheOperatingPoint) {
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    if (each.from == thermal::FromColumn::computed) {
      continue;
    }
    recording::Recording log;
    log.name = "log";
    log.time_s = {0.0, 1.0};
    log.run_begins = {0};
    log.channels.push_back({*recording::quantity_named(each.column), {-3.0, 4.0}});
    EXPECT_THAT(signals_of(log), testing::Contains(each.signal.value())) << each.name;
    const MeasuredRunOptions options{.ambient_C = 25.0};
    const LogRows rows(log, options);
    EXPECT_EQ(rows.at(0).*each.value, each.from == thermal::FromColumn::magnitude ? 3.0 : -3.0) << each.name;
    EXPECT_EQ(rows.at(1).*each.value, 4.0) << each.name;
    const thermal::QuantitySet bit = thermal::known_bit(thermal::quantity_row(each.name));
    EXPECT_EQ(rows.at(0).known, bit) << each.name << ": a law that asks whether it is known would ignore it";
  }
}

/// A law may use an optional quantity only where the log has a value.
TEST(SignalTable, OptionalQuantitiesAreUnknownWhereTheLogHasNoValue) {
  for (std::size_t row = 0; row < thermal::kQuantityCount; ++row) {
    const thermal::OperatingQuantity<double>& each = thermal::kQuantities<double>[row];
    if (!each.is_optional || each.column.empty()) {
      continue;
    }
    recording::Recording log;
    log.name = "log";
    log.time_s = {0.0, 2.0 * thresholds().slow_s};  // farther apart than gaps that are filled
    log.run_begins = {0};
    log.channels.push_back({*recording::quantity_named(each.column), {std::numeric_limits<double>::quiet_NaN(), 4.0}});
    const MeasuredRunOptions options{.ambient_C = 25.0};
    const LogRows rows(log, options);
    EXPECT_EQ(rows.at(0).known, 0U) << each.name;
    EXPECT_EQ(rows.at(0).*each.value, thermal::OperatingPoint<double>{}.*each.value) << each.name;
    EXPECT_EQ(rows.at(1).known, thermal::known_bit(row)) << each.name;
  }
}

/// A logger may write the hours of running once and a temperature every 30 s. Rows between are interpolated; none of them is lost.
TEST(SignalTable, SignalsLoggedLessOftenAreInterpolated) {
  constexpr std::size_t kRows = 301;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  recording::Recording log;
  log.name = "log";
  log.run_begins = {0};
  std::vector<double> age_h(kRows, unknown), neighbour_C(kRows, unknown), wind_m_per_s(kRows, unknown), stator_C;
  for (std::size_t row = 0; row < kRows; ++row) {
    log.time_s.push_back(static_cast<double>(row));
    stator_C.push_back(30.0 + 0.1 * static_cast<double>(row % 3));
    if (row % 30 == 0) {
      neighbour_C[row] = 40.0 + 0.1 * static_cast<double>(row);
      wind_m_per_s[row] = 0.01 * static_cast<double>(row);
    }
  }
  age_h[0] = 12.0;
  log.channels = {{*recording::quantity_named("age_h"), age_h},
                  {*recording::quantity_named("neighbour_C"), neighbour_C},
                  {*recording::quantity_named("vehicle_speed_m_per_s"), wind_m_per_s},
                  {*recording::quantity_named("stator_C"), stator_C}};
  const MeasuredRunOptions options{.needed = {thermal::Signal::age, thermal::Signal::neighbour_temperature, thermal::Signal::vehicle_speed},
                                   .ambient_C = 25.0};
  const LogRows rows(log, options);
  for (std::size_t row = 0; row < kRows; ++row) {
    const thermal::OperatingPoint<double> at = rows.at(row);
    EXPECT_EQ(at.age_h, 12.0) << row;
    EXPECT_TRUE(at.knows(thermal::kNeighbour)) << row;
    EXPECT_NEAR(at.neighbour_C, 40.0 + 0.1 * static_cast<double>(row), 1e-9) << row;
    EXPECT_NEAR(at.vehicle_speed_m_per_s, 0.01 * static_cast<double>(row), 1e-9) << row;
  }
  const MeasuredRuns runs = measured_runs(log, options);
  ASSERT_EQ(runs.runs.size(), 1U);
  EXPECT_EQ(runs.runs[0].time_s.back(), log.time_s.back());
  EXPECT_TRUE(runs.notes.empty());
}

/// No default of a temperature is safe: a law with a wrong one conducts heat to a body that is not there. The ambient temperature is the
/// exception, because every run has one.
TEST(SignalTable, TemperaturesAreOptional) {
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    EXPECT_EQ(each.is_optional && each.signal.has_value(), each.unit == "degC" && each.name != "ambient") << each.name;
  }
}

}  // namespace
}  // namespace heatsoak::estimation
