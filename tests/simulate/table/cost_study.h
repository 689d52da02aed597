// What limiting the current costs: the picture, and how long a hot robot must rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "guard_study.h"

namespace heatsoak::studies {

/// One way to limit at one level, over its motors and matches.
struct Cost {
  std::size_t motors = 0;
  std::size_t over_limit = 0;
  double hottest_C = 0.0;
  double driven_m = 0.0;      ///< mean
  double lost_m = 0.0;        ///< mean, against the same motor in the same match without limit
  double lost_percent = 0.0;  ///< of all that was driven without limit
  double off_plan_s = 0.0;    ///< mean
  double time_lost_s = 0.0;   ///< mean: more off the plan than without limit

  [[nodiscard]] bool keeps_limit() const { return over_limit == 0; }
};

struct CostRow {
  std::string way;
  bool is_guard = false;
  std::vector<Cost> by_knowledge;  ///< one per column of the picture
};
struct CostLevel {
  std::string name;
  std::vector<CostRow> rows;
};
/// Bars of distance and time for every level, way and knowledge, as SVG of 1200 px. Red: over the limit with at least one motor.
std::string draw_costs(const std::string& title, const std::vector<std::string>& subtitle, const std::vector<std::string>& knowledge,
                       const std::vector<CostLevel>& levels);

/// Exact one-sided upper bound (Clopper and Pearson 1934) of a share, with 95 % confidence.
double upper_bound(std::size_t hits, std::size_t count);

/// What a robot knows of its motor, and the guard that follows.
struct Knowledge {
  std::string name;
  const MotorGuard* guard = nullptr;
};
/// Writes rest.svg and rest.csv; returns the section of the report. `match` and `game` are of the middle level.
std::string study_rest(const HardMatch& match, const Game& game, const Motor& motor, const std::vector<Knowledge>& known,
                       const Report& report);

}  // namespace heatsoak::studies
