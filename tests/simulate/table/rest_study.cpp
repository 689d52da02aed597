// Rest that a hot robot needs before it can continue: the recorded load of one wheel, simulated with the thermal models.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/unknown.h"
#include "cost_study.h"
#include "limiters.h"
#include "robot_core/thermal_guard.h"

namespace heatsoak::simulate::studies {
namespace {

/// Load over one guard period.
struct Load {
  float current_A = 0.0F;  ///< RMS, with the sign of the mean
  float speed_rad_per_s = 0.0F;
};

constexpr double kPeriod_s = SimulatedRobot::kThermalPeriod_s;
constexpr double kWindows_s = 60.0;  ///< time between the starts of two windows of play
constexpr int kLongestRest_s = 3600;
constexpr double kLongestPlay_s = 1200.0;

/// Records the load of the wheel with the most copper loss.
std::vector<Load> record(const HardMatch& match, const Game& game, const motor::Motor& motor) {
  const GuardedCore core(match.robot, motor, GuardUse::off, {});
  MatchRunOptions options;
  options.ambient_C = match.ambient_C;
  options.drive = sensed_drive(match.robot, 1, true);
  std::array<std::vector<Load>, robot::kMostWheels> loads;
  std::array<double, robot::kMostWheels> heat_J{};
  struct Sum {
    double squared_A2 = 0.0;
    double current_A = 0.0;
    double speed_rad_per_s = 0.0;
  };
  std::array<Sum, robot::kMostWheels> sums;
  const int periods = static_cast<int>(std::lround(kPeriod_s / SimulatedRobot::kPeriod_s));
  int count = 0;
  run_match(game, match.robot, motor, core.config(), options, [&](const LoopMoment& moment) {
    const bool is_full = ++count == periods;
    for (int wheel = 0; wheel < moment.robot->wheel_count(); ++wheel) {
      const auto i = static_cast<std::size_t>(wheel);
      const double current_A = moment.out->current_A[i];
      sums[i].squared_A2 += current_A * current_A;
      sums[i].current_A += current_A;
      sums[i].speed_rad_per_s += moment.out->motor_speed_rad_per_s[i];
      heat_J[i] += moment.out->copper_W[i];
      if (is_full) {
        const double rms_A = std::sqrt(sums[i].squared_A2 / periods);
        loads[i].push_back(
            {static_cast<float>(std::copysign(rms_A, sums[i].current_A)), static_cast<float>(sums[i].speed_rad_per_s / periods)});
        sums[i] = {};
      }
    }
    count = is_full ? 0 : count;
  });
  return loads[static_cast<std::size_t>(std::ranges::max_element(heat_J) - heat_J.begin())];
}

struct Bodies {
  float winding_C = 0.0F;
  float stator_C = 0.0F;
};

/// Decides whether the robot may continue, by the guard or by the true motor.
class Judge {
 public:
  /// If `braking_reserve_K` is absent, this is the true motor, whose winding must stay within its limit. Otherwise it is the guard, which
  /// must not limit.
  Judge(std::string name, const firmware::HostGuard& guard, double braking_reserve_K)
      : name_(std::move(name)), guard_(guard), reserve_K_(braking_reserve_K) {}

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Temperatures of a motor that was held at its limit until the stator was steady, then rested without current; one entry per second.
  [[nodiscard]] std::vector<Bodies> rested(float air_C) const {
    const firmware::HostGuard own = guard_;
    const robot_core::GuardModel& model = own.model();
    constexpr float kStep_s = 0.05F;
    constexpr int kStepsPerSecond = 20;
    float state_C[2] = {model.winding_limit_C, air_C};
    const auto step = [&](int first_node) {
      float signal[robot_core::kGuardSignals] = {};
      signal[robot_core::guard_ambient_C] = air_C;
      float rate_K_per_s[2];
      model.rates(model.context, signal, state_C, rate_K_per_s);
      for (int node = first_node; node < 2; ++node) {
        state_C[node] += kStep_s * rate_K_per_s[node];
      }
    };
    for (int i = 0; i < kLongestRest_s * kStepsPerSecond; ++i) {
      step(1);
    }
    std::vector<Bodies> bodies;
    for (int second = 0; second <= kLongestRest_s; ++second) {
      bodies.push_back({state_C[0], state_C[1]});
      for (int i = 0; i < kStepsPerSecond; ++i) {
        step(0);
      }
    }
    return bodies;
  }

  /// Time until the guard limits or the winding exceeds its limit. The load starts at `first` and restarts when it ends.
  [[nodiscard]] double plays_s(const std::vector<Load>& load, std::size_t first, float air_C, Bodies start, double most_s) const {
    const firmware::HostGuard own = guard_;
    const robot_core::GuardModel& model = own.model();
    const bool is_true_motor = std::isnan(reserve_K_);
    const float reserve_K = is_true_motor ? 0.0F : static_cast<float>(reserve_K_);
    robot_core::GuardState state;
    robot_core::start_guard(model, state, air_C);
    state.state_C[0] = start.winding_C;
    state.state_C[1] = start.stator_C;
    robot_core::seal(state);
    float allowed_A = robot_core::allowed_current_A(model, 0.0F, start.stator_C, start.winding_C + reserve_K);
    float allowed_braking_A = robot_core::allowed_current_A(model, 0.0F, start.stator_C, start.winding_C);
    const auto steps = static_cast<std::size_t>(std::lround(most_s / kPeriod_s));
    for (std::size_t i = 0; i < steps; ++i) {
      const Load& now = load[(first + i) % load.size()];
      const bool brakes = now.current_A * now.speed_rad_per_s < 0.0F;
      const bool is_over =
          is_true_motor ? state.state_C[0] > model.winding_limit_C : std::abs(now.current_A) > (brakes ? allowed_braking_A : allowed_A);
      if (is_over) {
        return static_cast<double>(i) * kPeriod_s;
      }
      float signal[robot_core::kGuardSignals] = {};
      signal[robot_core::guard_current_A] = now.current_A;
      signal[robot_core::guard_speed_rad_per_s] = now.speed_rad_per_s;
      signal[robot_core::guard_ambient_C] = air_C;
      const robot_core::GuardOutput out = robot_core::step_guard(model, state, signal, reserve_K);
      allowed_A = out.allowed_A;
      allowed_braking_A = out.allowed_braking_A;
    }
    return most_s;
  }

 private:
  std::string name_;
  firmware::HostGuard guard_;
  double reserve_K_;
};

/// Returns the shortest rest in whole seconds before a window of play is possible; absent if even a cold motor cannot play it. A longer
/// rest is always possible, too.
double rest_needed_s(const Judge& judge, const std::vector<Load>& load, std::size_t first, float air_C, const std::vector<Bodies>& rested,
                     double play_s) {
  const auto is_enough = [&](Bodies start) { return judge.plays_s(load, first, air_C, start, play_s) >= play_s; };
  if (!is_enough({air_C, air_C})) {
    return base::kUnknown;
  }
  std::size_t low = 0;
  std::size_t high = rested.size() - 1;
  if (is_enough(rested[low])) {
    return 0.0;
  }
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (is_enough(rested[middle]) ? high : low) = middle;
  }
  return static_cast<double>(high);
}

struct Row {
  const Judge* judge = nullptr;
  float air_C = 0.0F;
  std::vector<Bodies> rested;
  std::vector<std::vector<double>> rest_s;  ///< [length of play][window]; absent means never
  std::vector<double> median_s;             ///< medians of the play time, over kRests_s
};
constexpr double kPlays_s[] = {60.0, 300.0, 1200.0};
constexpr double kRestStep_s = 30.0;
constexpr std::size_t kRests = 31;

double median(std::vector<double> values) {
  for (double& each : values) {
    each = std::isnan(each) ? std::numeric_limits<double>::infinity() : each;
  }
  std::ranges::sort(values);
  // Upper median: after this rest at least half of the windows are possible.
  return values[values.size() / 2];
}

std::string rest_text(double rest_s) {
  if (!std::isfinite(rest_s)) {
    return "never";
  }
  const int whole_s = static_cast<int>(std::lround(rest_s));
  return fmt::format("{}:{:02}", whole_s / 60, whole_s % 60);
}

std::string never_text(const std::vector<double>& rests_s) {
  const auto never = std::ranges::count_if(rests_s, [](double each) { return std::isnan(each); });
  return never == 0 ? std::string() : fmt::format(" ({} of {} windows never)", never, rests_s.size());
}

}  // namespace

std::string study_rest(const HardMatch& match, const Game& game, const motor::Motor& motor, const std::vector<Knowledge>& known,
                       const Report& report) {
  const std::vector<Load> load = record(match, game, motor);
  const double squared_A2 = std::transform_reduce(load.begin(), load.end(), 0.0, std::plus<>(), [](const Load& each) {
    return static_cast<double>(each.current_A) * static_cast<double>(each.current_A);
  });
  std::vector<Judge> judges;
  judges.emplace_back("nominal motor, winding within its limit", firmware::HostGuard(derating_with(1.0, motor, match.robot)),
                      base::kUnknown);
  for (const Knowledge& each : known) {
    judges.emplace_back(each.name, *each.guard->guard, firmware::braking_reserve_K(match.robot, motor.nominal, *each.guard->derating));
  }
  std::vector<std::size_t> firsts;
  const auto apart = static_cast<std::size_t>(std::lround(kWindows_s / kPeriod_s));
  for (std::size_t first = 0; first < load.size(); first += apart) {
    firsts.push_back(first);
  }
  std::vector<Row> rows;
  for (const float air_C : {25.0F, 40.0F}) {
    for (const Judge& judge : judges) {
      rows.push_back(
          {.judge = &judge, .air_C = air_C, .rested = judge.rested(air_C), .rest_s = {}, .median_s = std::vector<double>(kRests)});
      rows.back().rest_s.assign(std::size(kPlays_s), std::vector<double>(firsts.size()));
    }
  }
  constexpr std::size_t kPlays = std::size(kPlays_s);
  base::in_parallel(rows.size() * kPlays * firsts.size(), 0, [&](std::size_t job) {
    Row& row = rows[job / (kPlays * firsts.size())];
    const std::size_t play = job / firsts.size() % kPlays;
    const std::size_t window = job % firsts.size();
    row.rest_s[play][window] = rest_needed_s(*row.judge, load, firsts[window], row.air_C, row.rested, kPlays_s[play]);
  });
  base::in_parallel(rows.size() * kRests, 0, [&](std::size_t job) {
    Row& row = rows[job / kRests];
    const Bodies start = row.rested[static_cast<std::size_t>(kRestStep_s) * (job % kRests)];
    std::vector<double> plays_s;
    for (const std::size_t first : firsts) {
      plays_s.push_back(row.judge->plays_s(load, first, row.air_C, start, kLongestPlay_s));
    }
    row.median_s[job % kRests] = median(plays_s);
  });

  Sheet sheet{{"air / °C", "judged by", "stator when hot / °C", "1 min: median", "1 min: worst", "5 min: median", "5 min: worst",
               "20 min: median", "20 min: worst"},
              {}};
  Sheet csv{{"air_C", "judged_by", "play_s", "window_start_s", "rest_s"}, {}};
  for (const Row& row : rows) {
    std::vector<std::string> cells{fmt::format("{:.0f}", row.air_C), row.judge->name(), fmt::format("{:.0f}", row.rested.front().stator_C)};
    for (std::size_t play = 0; play < kPlays; ++play) {
      const std::vector<double>& rests_s = row.rest_s[play];
      const bool has_never = std::ranges::any_of(rests_s, [](double each) { return std::isnan(each); });
      cells.push_back(rest_text(median(rests_s)));
      cells.push_back(has_never ? "never" + never_text(rests_s) : rest_text(*std::ranges::max_element(rests_s)));
      for (std::size_t window = 0; window < firsts.size(); ++window) {
        csv.rows.push_back({fmt::format("{:.0f}", row.air_C), "\"" + row.judge->name() + "\"", fmt::format("{:.0f}", kPlays_s[play]),
                            fmt::format("{:.0f}", static_cast<double>(firsts[window]) * kPeriod_s),
                            std::isnan(rests_s[window]) ? "never" : fmt::format("{:.0f}", rests_s[window])});
      }
    }
    sheet.rows.push_back(std::move(cells));
  }
  constexpr std::size_t kShown = 4;
  report::Chart chart{
      .title = fmt::format("After {:.0f} min of rest, bench data: {:.0f} min of play at 25 °C, {:.0f} min at 40 °C",
                           kShown * kRestStep_s / 60.0, rows[1].median_s[kShown] / 60.0, rows[judges.size() + 1].median_s[kShown] / 60.0),
      .subtitle = fmt::format("half-way level, load of the hottest wheel, {} windows of play: median; 20 min is as long as was played",
                              firsts.size()),
      .x_label = "rest of the hot robot / min",
      .panels = {},
      .panel_height_px = 320};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t place = r % judges.size();
    if (place == 0) {
      chart.panels.push_back({.title = fmt::format("Air of {:.0f} °C", rows[r].air_C),
                              .y_label = "play until limited / min",
                              .curves = {},
                              .bands = {},
                              .levels = {}});
    }
    constexpr int kColors[] = {0, 2, 1};
    // Dashes show the curve below, where both play to the end.
    report::ChartCurve curve{.name = r < judges.size() ? rows[r].judge->name() : "",
                             .color_index = kColors[place % std::size(kColors)],
                             .dashed = place == 1};
    for (std::size_t i = 0; i < kRests; ++i) {
      curve.x.push_back(static_cast<double>(i) * kRestStep_s / 60.0);
      curve.y.push_back(rows[r].median_s[i] / 60.0);
    }
    chart.panels.back().curves.push_back(std::move(curve));
  }
  report.draw("rest.svg", chart);
  report.write("rest.csv", csv.csv());
  return fmt::format(
      "## Rest of a hot robot\n\nLoad: wheel with the most heat of the first half-way match, {:.1f} min, {:.2f} A RMS, recorded with the "
      "nominal "
      "motor without limit; {} windows of play begin every {:.0f} s. Rest in min:s. Never: "
      "even from cold the guard limits (or the winding is over its limit) at least once within the window.\n\n{}",
      static_cast<double>(load.size()) * kPeriod_s / 60.0, std::sqrt(squared_A2 / static_cast<double>(load.size())), firsts.size(),
      kWindows_s, sheet.markdown());
}

}  // namespace heatsoak::simulate::studies
