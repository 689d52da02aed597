// Cost of limiting the current: the chart, and the rest that a hot robot needs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "guard_study.h"

namespace heatsoak::simulate::studies {

/// One limiting method at one level, over its motors and matches.
struct Cost {
  std::size_t motors = 0;
  std::size_t over_limit = 0;
  double hottest_C = 0.0;
  double driven_m = 0.0;      ///< mean
  double lost_m = 0.0;        ///< mean, relative to the same motor in the same match without limit
  double lost_percent = 0.0;  ///< share of the distance driven without limit
  double off_plan_s = 0.0;    ///< mean
  double time_lost_s = 0.0;   ///< mean of the additional time off the plan, relative to no limit

  [[nodiscard]] bool keeps_limit() const { return over_limit == 0; }
};

struct CostRow {
  std::string way;
  bool is_guard = false;
  std::vector<Cost> by_knowledge;  ///< one per column of the chart
};
struct CostLevel {
  std::string name;
  std::vector<CostRow> rows;
};
/// Draws bars of distance and time for every level, method and knowledge as SVG of 1200 px. Red bars exceed the limit with at least one
/// motor.
std::string draw_costs(const std::string& title, const std::vector<std::string>& subtitle, const std::vector<std::string>& knowledge,
                       const std::vector<CostLevel>& levels);

/// A robot's knowledge of its motor, and the resulting guard.
struct Knowledge {
  std::string name;
  const MotorGuard* guard = nullptr;
};
/// Writes rest.svg and rest.csv and returns the section of the report. `match` and `game` belong to the middle level.
std::string study_rest(const HardMatch& match, const Game& game, const motor::Motor& motor, const std::vector<Knowledge>& known,
                       const Report& report);

}  // namespace heatsoak::simulate::studies
