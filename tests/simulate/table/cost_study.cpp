// Cost of limiting at three levels of aggressiveness: the guard compared with other methods. Two of them are tuned in hindsight, one
// knows the true motor.
#include "cost_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/unknown.h"
#include "limiters.h"

namespace heatsoak::simulate::studies {

namespace {

constexpr std::size_t kMatches = 3;
constexpr std::size_t kFirstSeed = 11;  ///< the guard's approach time was chosen with the matches of seeds 1 to 3
constexpr std::size_t kMotors = 9;      ///< motors, each assigned to one of the matches

enum class Method : std::uint8_t {
  none,
  sheet_cap,
  sheet_cap_unsensed,
  stator_ramp,
  overload,
  guard_unsensed,
  guard,
  hindsight_cap,
  hindsight_guard,
  oracle
};
struct MethodSpec {
  Method method;
  const char* key;
  const char* name;
};
constexpr std::array<MethodSpec, 10> kMethods{{{Method::none, "none", "no limit"},
                                               {Method::sheet_cap, "cap_data_sheet", "cap, data sheet's continuous"},
                                               {Method::sheet_cap_unsensed, "cap_data_sheet_unsensed", "the same cap, nothing sensed"},
                                               {Method::stator_ramp, "stator_ramp", "stator ramp 85 to 100 °C"},
                                               {Method::overload, "i2t", "I²t, data sheet's peak"},
                                               {Method::guard_unsensed, "guard_unsensed", "guard, nothing sensed"},
                                               {Method::guard, "guard", "guard, current and air sensed"},
                                               {Method::hindsight_cap, "cap_hindsight", "cap found in hindsight"},
                                               {Method::hindsight_guard, "guard_hindsight", "guard, factor found in hindsight"},
                                               {Method::oracle, "oracle", "oracle (true motor)"}}};
constexpr std::size_t place_of(Method method) { return static_cast<std::size_t>(method); }
constexpr bool is_guard(Method method) { return method == Method::guard || method == Method::guard_unsensed; }
/// True if the method is tuned to the very motors and matches that it is judged by.
constexpr bool is_hindsight(Method method) { return method == Method::hindsight_cap || method == Method::hindsight_guard; }
constexpr bool has_sensors(Method method) { return method != Method::guard_unsensed && method != Method::sheet_cap_unsensed; }

struct Level {
  std::string name;
  const char* key;
  HardMatch match;
  std::vector<Game> games;  ///< generated games of the seeds from kFirstSeed on
};

struct Known {
  std::string name;
  const char* key;
  motor::Motor motor;
  MotorGuard guard;
  std::vector<motor::Motor> drawn;
  std::vector<derate::Derating> exact;  ///< one per drawn motor
};

struct Run {
  double peak_C = 0.0;
  double distance_m = 0.0;
  double off_plan_s = 0.0;
};

/// Results for one level and one knowledge of the motor.
struct Cell {
  const Level* level = nullptr;
  const Known* known = nullptr;
  // Found in hindsight; empty if no limit is needed.
  std::optional<double> cap_A = {};
  std::optional<double> heat_factor = {};
  std::array<std::vector<Run>, kMethods.size()> runs;
};

const Game& game_of(const Level& level, std::size_t motor) { return level.games[motor % kMatches]; }
std::uint64_t seed_of(std::size_t motor) { return motor % kMatches + kFirstSeed; }

/// `heat_factor`: safety factor on heat of the guard that is found in hindsight.
std::unique_ptr<Limiter> make_limiter(Method method, const Known& known, std::size_t i, const robot::Robot& robot,
                                      std::optional<double> heat_factor) {
  const derate::Derating& exact = known.exact[i];
  const motor::Motor& motor = known.drawn[i];
  const double ratio = motor.nominal.terminal_resistance_ohm / known.motor.nominal.terminal_resistance_ohm;
  switch (method) {
    case Method::sheet_cap:
      return Limiter::fixed_cap(exact, ratio, overload_of(known.motor.nominal).continuous_A);
    case Method::stator_ramp:
      return Limiter::stator_ramp(exact, ratio, 85.0, 100.0);
    case Method::overload:
      return Limiter::i_squared_t(exact, ratio, overload_of(known.motor.nominal));
    case Method::oracle:
      return Limiter::guard(exact, ratio, firmware::braking_reserve_K(robot, motor.nominal, exact));
    case Method::hindsight_guard: {
      const derate::Derating tuned = derating_with(heat_factor.value(), known.motor, robot);
      return Limiter::guard(tuned, 1.0, firmware::braking_reserve_K(robot, known.motor.nominal, tuned));
    }
    default:
      return nullptr;
  }
}

/// `setting`: of a method that is found in hindsight, the cap in A or the safety factor on heat.
Run drive(const Level& level, const Known& known, Method method, std::size_t i, std::optional<double> setting = {}) {
  robot::Robot robot = level.match.robot;
  // The firmware limits the current through the voltage and the lowest resistance, so a cold winding gets more than a warm one.
  if (method == Method::hindsight_cap) {
    robot.drive.current_limit_A = setting.value();
  } else if (method == Method::sheet_cap_unsensed) {
    robot.drive.current_limit_A = overload_of(known.motor.nominal).continuous_A;
  }
  const Game& game = game_of(level, i);
  Hardship hardship;
  if (const std::unique_ptr<Limiter> limiter = make_limiter(method, known, i, robot, setting)) {
    hardship = drive_hard(level.match, game, limiter->config(robot, known.motor), has_sensors(method), known.drawn[i], seed_of(i), false);
  } else {
    const GuardedCore core(robot, known.motor, is_guard(method) ? GuardUse::on : GuardUse::off, known.guard);
    hardship = drive_hard(level.match, game, core.config(), has_sensors(method), known.drawn[i], seed_of(i), false);
  }
  return {hardship.score.winding_peak_C, hardship.score.distance_m, hardship.off_plan_s};
}

/// Finds the setting of `method` closest to `loose`, to `accuracy`, with which all motors keep their limits in their matches, and drives
/// all motors with it. The search starts with the motor that is hottest without limit and continues with any motor that still exceeds its
/// limit. Returns nothing if no limit is needed.
std::optional<double> find_setting(Cell& cell, Method method, double strict, double loose, double accuracy) {
  std::vector<Run>& runs = cell.runs[place_of(method)];
  runs = cell.runs[place_of(Method::none)];
  const double limit_C = cell.known->motor.nominal.winding_limit_C;
  std::optional<double> found;
  for (;;) {
    const auto hottest = static_cast<std::size_t>(std::ranges::max_element(runs, {}, &Run::peak_C) - runs.begin());
    if (runs[hottest].peak_C <= limit_C) {
      return found;
    }
    double keeps = strict;
    while (std::abs(loose - keeps) > accuracy) {
      const double tried = 0.5 * (keeps + loose);
      (drive(*cell.level, *cell.known, method, hottest, tried).peak_C <= limit_C ? keeps : loose) = tried;
    }
    found = loose = keeps;
    base::in_parallel(kMotors, 0, [&](std::size_t i) { runs[i] = drive(*cell.level, *cell.known, method, i, keeps); });
  }
}

void find_settings(Cell& cell) {
  cell.cap_A = find_setting(cell, Method::hindsight_cap, 0.5, 12.0, 0.1);
  cell.heat_factor = find_setting(cell, Method::hindsight_guard, 3.0, 1.0, 0.01);
}

void run_all(std::vector<Cell>& cells, std::initializer_list<Method> methods) {
  struct Job {
    Cell* cell;
    Method method;
    std::size_t motor;
  };
  std::vector<Job> jobs;
  for (Cell& cell : cells) {
    for (const Method method : methods) {
      cell.runs[place_of(method)].resize(kMotors);
      for (std::size_t i = 0; i < kMotors; ++i) {
        jobs.push_back({&cell, method, i});
      }
    }
  }
  base::in_parallel(jobs.size(), 0, [&](std::size_t j) {
    const Job& job = jobs[j];
    job.cell->runs[place_of(job.method)][job.motor] = drive(*job.cell->level, *job.cell->known, job.method, job.motor);
  });
}

Cost cost_of(const Cell& cell, Method method) {
  Cost cost{.motors = kMotors};
  double free_m = 0.0;
  for (std::size_t i = 0; i < kMotors; ++i) {
    const Run& free = cell.runs[place_of(Method::none)][i];
    const Run& run = cell.runs[place_of(method)][i];
    cost.over_limit += run.peak_C > cell.known->motor.nominal.winding_limit_C ? 1 : 0;
    cost.hottest_C = std::max(cost.hottest_C, run.peak_C);
    constexpr double kShare = 1.0 / kMotors;
    cost.driven_m += kShare * run.distance_m;
    cost.lost_m += kShare * (free.distance_m - run.distance_m);
    cost.off_plan_s += kShare * run.off_plan_s;
    cost.time_lost_s += kShare * (run.off_plan_s - free.off_plan_s);
    free_m += kShare * free.distance_m;
  }
  cost.lost_percent = 100.0 * cost.lost_m / free_m;
  return cost;
}

std::string name_of(const Cell& cell, const MethodSpec& spec) {
  switch (spec.method) {
    case Method::sheet_cap:
    case Method::sheet_cap_unsensed:
      return fmt::format("{}, {:.1f} A", spec.name, overload_of(cell.known->motor.nominal).continuous_A);
    case Method::hindsight_cap:
      return cell.cap_A ? fmt::format("{}: {:.1f} A", spec.name, *cell.cap_A) : fmt::format("{}: none needed", spec.name);
    case Method::hindsight_guard:
      return cell.heat_factor ? fmt::format("{}: {:.2f}", spec.name, *cell.heat_factor) : fmt::format("{}: none needed", spec.name);
    default:
      return spec.name;
  }
}

/// Formats a number without "-0.0".
std::string number(double value, int decimals) {
  const double step = std::pow(10.0, -decimals);
  return fmt::format("{:.{}f}", std::abs(value) < 0.5 * step ? 0.0 : value, decimals);
}

std::string cost_table(const Cell& cell) {
  Sheet sheet{{"way", "keeps the limit", "motors over the limit", "hottest winding / °C", "distance / m", "distance not driven / m",
               "distance not driven / %", "off the plan / s", "time lost / s"},
              {}};
  for (const MethodSpec& spec : kMethods) {
    const Cost cost = cost_of(cell, spec.method);
    sheet.rows.push_back({name_of(cell, spec), cost.keeps_limit() ? "yes" : "**no**", fmt::format("{} of {}", cost.over_limit, cost.motors),
                          number(cost.hottest_C, 0), number(cost.driven_m, 0), number(cost.lost_m, 1), number(cost.lost_percent, 1),
                          number(cost.off_plan_s, 0), number(cost.time_lost_s, 0)});
  }
  return sheet.markdown();
}

std::string level_table(const std::vector<Level>& levels) {
  Sheet sheet{{"input"}, {}};
  for (const Level& level : levels) {
    sheet.header.push_back(level.name);
  }
  for (std::size_t i = 0; i < levels.front().match.changed.size(); ++i) {
    sheet.rows.push_back({levels.front().match.changed[i].name});
    for (const Level& level : levels) {
      sheet.rows.back().push_back(level.match.changed[i].hard);
    }
  }
  return sheet.markdown();
}

Sheet all_runs(const std::vector<Cell>& cells) {
  Sheet sheet{{"level", "known_from", "way", "motor", "match", "winding_peak_C", "distance_m", "off_plan_s", "lost_m", "time_lost_s"}, {}};
  for (const Cell& cell : cells) {
    for (const MethodSpec& spec : kMethods) {
      for (std::size_t i = 0; i < kMotors; ++i) {
        const Run& free = cell.runs[place_of(Method::none)][i];
        const Run& run = cell.runs[place_of(spec.method)][i];
        sheet.rows.push_back({cell.level->key, cell.known->key, spec.key, fmt::format("{}", i + 1), fmt::format("{}", seed_of(i)),
                              number(run.peak_C, 1), number(run.distance_m, 1), number(run.off_plan_s, 1),
                              number(free.distance_m - run.distance_m, 1), number(run.off_plan_s - free.off_plan_s, 1)});
      }
    }
  }
  return sheet;
}

/// Smallest lost distance of the other methods that a team can choose before the match and that overheat no motor. The oracle is excluded,
/// because it needs the true motor.
double best_rival_percent(const Cell& cell) {
  double least = std::numeric_limits<double>::infinity();
  for (const MethodSpec& spec : kMethods) {
    const Cost cost = cost_of(cell, spec.method);
    if (spec.method != Method::none && spec.method != Method::oracle && !is_hindsight(spec.method) && !is_guard(spec.method) &&
        cost.keeps_limit()) {
      least = std::min(least, cost.lost_percent);
    }
  }
  return least;
}

/// `cells` are ordered by level, then by knowledge.
std::string picture(const std::vector<Level>& levels, const std::vector<Known>& known, const std::vector<Cell>& cells) {
  std::vector<CostLevel> shown;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    CostLevel level{levels[l].name, {}};
    for (const MethodSpec& spec : kMethods) {
      CostRow row{.way = spec.name, .is_guard = is_guard(spec.method), .by_knowledge = {}};
      for (std::size_t k = 0; k < known.size(); ++k) {
        row.by_knowledge.push_back(cost_of(cells[l * known.size() + k], spec.method));
      }
      level.rows.push_back(std::move(row));
    }
    shown.push_back(std::move(level));
  }
  const Cell& bench = cells.back();
  const Cell& file = cells[cells.size() - 2];
  const std::string title =
      fmt::format("Distance lost in the hard match: guard {} %, best other way {} % (bench data); {} % and {} % (estimates)",
                  number(cost_of(bench, Method::guard).lost_percent, 1), number(best_rival_percent(bench), 1),
                  number(cost_of(file, Method::guard).lost_percent, 1), number(best_rival_percent(file), 1));
  return draw_costs(
      title,
      {fmt::format("Twente v2024, ECX FLAT 32 L, division_a_match, simulated with real sensing: {} motors that represent "
                   "the tolerances, {} synthetic matches, each motor in one; means",
                   kMotors, kMatches),
       fmt::format("Against the same motor in the same match without limit. Time lost: more than {:.0f} mm off the plan, beyond "
                   "what the unlimited robot is.",
                   1e3 * kOffPlan_m),
       "Found in hindsight: for exactly these motors and matches, which no team knows in advance; the title is about the other ways.",
       "Below 0 %: a robot that lags, overshoots and comes back drives further than its plan."},
      {"motor known from its file (estimates)", "motor known from a bench test"}, shown);
}

Known make_known(std::string name, const char* key, motor::Motor motor, const robot::Robot& robot) {
  Known known{std::move(name), key, std::move(motor), {}, {}, {}};
  known.guard = make_guard(known.motor, robot, 40.0, 0);
  known.drawn = representative_motors(known.motor, kMotors);
  std::vector<std::optional<derate::Derating>> exact(kMotors);
  base::in_parallel(kMotors, 0, [&](std::size_t i) { exact[i].emplace(derating_with(1.0, known.drawn[i], robot)); });
  for (std::optional<derate::Derating>& each : exact) {
    known.exact.push_back(std::move(*each));
  }
  return known;
}

}  // namespace

void study_costs(const Subject& subject, const Report& report) {
  struct LevelSpec {
    const char* name;
    const char* key;
    double share;
  };
  constexpr LevelSpec kLevels[] = {{"division_a_match as it is", "as_is", 0.0}, {"half-way", "half_way", 0.5}, {"hard match", "hard", 1.0}};
  std::vector<Level> levels;
  for (const LevelSpec& spec : kLevels) {
    Level level{spec.name, spec.key, make_hard_match(subject.robot, spec.share), {}};
    for (std::size_t seed = kFirstSeed; seed < kFirstSeed + kMatches; ++seed) {
      level.games.push_back(play_game(level.match.inputs, level.match.robot, seed));
    }
    levels.push_back(std::move(level));
  }
  std::vector<Known> known;
  known.push_back(make_known("motor known from its file (estimates)", "file", subject.motor, subject.robot));
  known.push_back(make_known("motor known from a bench test", "bench_test", bench_tested(subject.motor), subject.robot));
  std::vector<Cell> cells;
  for (const Level& level : levels) {
    for (const Known& each : known) {
      cells.push_back({.level = &level, .known = &each, .runs = {}});
    }
  }
  run_all(cells, {Method::none});
  base::in_parallel(cells.size(), 0, [&](std::size_t i) { find_settings(cells[i]); });
  run_all(cells, {Method::sheet_cap, Method::sheet_cap_unsensed, Method::stator_ramp, Method::overload, Method::guard_unsensed,
                  Method::guard, Method::oracle});

  const Overload overload = overload_of(subject.motor.nominal);
  std::string text = fmt::format(
      "## Three levels\n\n{}\n{} matches; {} motors that represent the tolerances, each in one match: of 1000 motors drawn within "
      "the tolerances and ordered by their rise per square of the torque in steady state, the middle of each ninth. The hottest is at the "
      "94th percentile.\n\n"
      "I²t: continuous {:.2f} A, peak {:.1f} A for {:.3f} s, budget {:.0f} A²s.\n\n",
      level_table(levels), kMatches, kMotors, overload.continuous_A, overload.peak_A, overload.peak_s, overload.budget_A2_s());
  for (const Cell& cell : cells) {
    text += fmt::format("## {}, {}\n\n{}\n", cell.level->name, cell.known->name, cost_table(cell));
  }
  text += study_rest(levels[1].match, levels[1].games.front(), subject.motor,
                     {{"guard, bench data", &known[1].guard}, {"guard, file's estimates", &known[0].guard}}, report);
  report.write("costs.md", text);
  report.write("costs.csv", all_runs(cells).csv());
  report.write("costs.svg", picture(levels, known, cells));
}

}  // namespace heatsoak::simulate::studies
