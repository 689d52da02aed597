#include "derate/derating.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

#include "base/binomial_bound.h"
#include "base/diagnostic.h"
#include "derate/motor_verdicts.h"
#include "derate/own_friction.h"
#include "derate/search_work.h"
#include "derate/sensed/sensor_plan.h"
#include "derate/smallest_factor.h"
#include "motor/datasheet_network.h"
#include "motor/conditions.h"
#include "motor/measured_power.h"
#include "robot/motor_drive.h"
#include "thermal/ensemble.h"

namespace heatsoak::derate {
namespace {

constexpr double kLargestReserve = 16.0;
/// Offset between the random streams of the search and those of the check.
constexpr std::uint64_t kStreamsApart = std::uint64_t{1} << 32U;

/// Voltage of a full battery in V; the nominal voltage if the robot's file gives none.
double full_V(const robot::Robot& robot) {
  return std::max(robot.battery.nominal_V, robot.battery.full_V.value_or(robot.battery.nominal_V));
}

}  // namespace

namespace {

/// Returns the lower end of a limit that the file gives as a range, because its true value is unknown.
double lowest_limit_C(const motor::Motor& motor, std::string_view key, double nominal_C) {
  const auto parameter = motor.parameters.find(key);
  return parameter != motor.parameters.end() && parameter->second.spread ? std::min(nominal_C, parameter->second.spread->low) : nominal_C;
}

}  // namespace

double approach_s(const motor::Motor& motor, const DerateOptions& options) {
  const double winding_s = motor.nominal.thermal_time_constant_winding_s;
  const double approach_s = options.approach_s.value_or(kApproach_ratio * winding_s);
  if (approach_s > winding_s) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("an approach of {:.4g} s is longer than the winding's time constant of {:.4g} s, so a hotter winding "
                                    "would be allowed more current; expected at most that time constant",
                                    approach_s, winding_s));
  }
  return approach_s;
}

BarrierRules barrier_rules(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options) {
  const motor::MotorValues& values = motor.nominal;
  const double loop_ohm = values.terminal_resistance_ohm + robot.series_resistance_ohm();
  BarrierRules rules;
  rules.limits.winding_C = lowest_limit_C(motor, "winding_limit", values.winding_limit_C);
  if (values.stator_limit_C) {
    rules.limits.stator_C = lowest_limit_C(motor, "stator_limit", *values.stator_limit_C);
  }
  if (!(rules.limits.winding_C > options.hottest_ambient_C)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{}: the winding limit of {:.1f} °C is not above the hottest air of {:.1f} °C, expected "
                                    "a higher limit; check winding_limit or state cooler air with --ambient",
                                    motor.id, rules.limits.winding_C, options.hottest_ambient_C));
  }
  rules.approach_s = approach_s(motor, options);
  // The stator must approach its limit more slowly than a winding without current gives off its stored heat.
  constexpr double kWindingTimes = 3.0;
  rules.stator_approach_s = std::max(rules.approach_s, kWindingTimes * values.thermal_time_constant_winding_s);
  rules.hottest_ambient_C = options.hottest_ambient_C;
  // When braking at full speed, the back-EMF adds to the supply voltage.
  rules.most_current_A = robot.drive.limited_A(2.0 * robot.available_V() / loop_ohm);
  rules.most_speed_rad_per_s = kPushed_ratio * robot.drive.limited_V(full_V(robot)) / values.torque_constant_Nm_per_A;
  // Other firmware may use the full battery voltage of a driver whose command is limited here.
  rules.no_current_speed_rad_per_s =
      std::max(kSpeedFadeOut_ratio * rules.most_speed_rad_per_s, kPushed_ratio * full_V(robot) / values.torque_constant_Nm_per_A);
  rules.most_vehicle_speed_m_per_s = rules.most_speed_rad_per_s / robot.drive.gear_ratio * robot.wheels.radius_m;
  return rules;
}

namespace {

void require_short_period(const thermal::Network& network, const robot::Robot& robot, const BarrierRules& rules,
                          const DerateOptions& options) {
  std::vector<thermal::Lanes> parameters;
  for (const double value : network.values()) {
    parameters.emplace_back(thermal::Lanes::Constant(value));
  }
  thermal::OperatingPoint<thermal::Lanes> at;
  at.ambient_C = thermal::Lanes::Constant(options.hottest_ambient_C);
  at.current_rms_A = thermal::Lanes::Constant(rules.most_current_A);
  const bool is_limited = robot.drive.current_limit_A.has_value();
  // The guard accepts speeds up to less than this (belief.cpp).
  const double fastest_rad_per_s = std::max(2.0 * rules.most_speed_rad_per_s, rules.no_current_speed_rad_per_s.value_or(0.0));
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = thermal::Lanes::Constant(fastest_rad_per_s);
  const double longest_s = 0.2 * thermal::longest_step_s(network, parameters, at, rules.limits.winding_C - options.hottest_ambient_C);
  // At this current copper heats the winding so fast that the growth of its resistance shortens the time constant.
  const std::string reason =
      longest_s < 0.1 * rules.approach_s && !is_limited
          ? fmt::format(
                ". The robot has no current_limit, and its battery can drive {:.3g} A through this motor, which heats the winding that "
                "fast. State the limit of its motor driver as [drive] current_limit",
                rules.most_current_A)
          : std::string();
  if (options.period_s > longest_s || options.period_s > 0.1 * rules.approach_s) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("a period of {:.3g} s is too long: expected --period {:.3g}s or shorter, the smaller "
                                    "of 1/20 of this motor's fastest time constant and 1/10 of --approach{}",
                                    options.period_s, std::min(longest_s, 0.1 * rules.approach_s), reason));
  }
}

void require_samples(const GuaranteeOptions& options) {
  if (const long least = least_samples(options); options.samples < least) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{} samples cannot show a confidence of {:.4g} with {:.0f} % certainty: expected --samples {} or more",
                                    options.samples, options.required_share, 100.0 * kCertainty_share, least));
  }
}

/// One safety factor on heat and the guard that follows from it.
struct Attempt {
  double safety_factor;
  Observer observer;
  BarrierRules rules;
  CurrentTable table;
  std::vector<LoadPattern> patterns;
  std::vector<std::optional<UsePlayed>> uses;  ///< per pattern; nothing: not played yet
};

class Search {
 public:
  Search(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options, SearchWork& work)
      : motor_(motor),
        robot_(robot),
        options_(options),
        reachable_(barrier_rules(motor, robot, options)),
        work_(work),
        network_(motor::datasheet_network(motor, motor::nominal_sample(motor))) {
    require_short_period(network_, robot, reachable_, options);
  }

  [[nodiscard]] const thermal::Network& network() const { return network_; }
  [[nodiscard]] const BarrierRules& reachable() const { return reachable_; }

  /// Returns the smallest safety factor at which the share of the search's motors that keep their limits reaches the confidence.
  double reserve() {
    constexpr double kGrowth = 1.5;
    const GuaranteeOptions& goal = options_.guarantee;
    MotorVerdicts motors(motor_, reachable_.limits, goal, 0, simulated());
    return smallest(1.0, kGrowth, motors, static_cast<int>((1.0 - goal.required_share) * goal.samples));
  }

  struct Promise {
    Observer observer;
    BarrierRules rules;
    CurrentTable table;
    std::vector<UsePlayed> uses;
    Guarantee guarantee;
  };
  /// Returns the smallest safety factor of its grid, at least `from`, at which at most most_over() independently drawn motors exceed a
  /// limit. All attempts use the same motors. A motor that keeps its limits also keeps them at a larger factor. The result is therefore at
  /// least an order statistic of the factors that the motors need, which shows the required share (Wilks 1941). It shows no larger share,
  /// even if fewer motors are over.
  Promise promise(double from) {
    constexpr double kGrowth = 1.05;
    const GuaranteeOptions& goal = options_.guarantee;
    work_.begin(SearchWork::factor_of_promise);
    MotorVerdicts motors(motor_, reachable_.limits, goal, kStreamsApart, simulated());
    for (;;) {
      const double found = smallest(from, kGrowth, motors, most_over(goal).value());
      Attempt last = std::move(*last_);
      std::vector<UsePlayed> uses = all_uses(last);
      work_.begin(SearchWork::final_check);
      const std::size_t per_block = base::kLanes * uses.size();
      const Guarantee guarantee =
          check(motor_, reachable_.limits, uses, goal, kStreamsApart, [&](std::size_t, std::size_t) { work_.add(per_block); });
      if (guarantee.over <= most_over(goal)) {
        return {std::move(last.observer), last.rules, std::move(last.table), std::move(uses), guarantee};
      }
      // The full check may find another motor over its limit, by the rounding of MotorVerdicts.
      constexpr double kNext = 1.01;
      from = kNext * found;
    }
  }

  [[nodiscard]] base::Failure too_hot() const {
    return {
        base::ExitCode::limit_exceeded,
        fmt::format("{}: fewer than {:.0f} % of the motors with the declared tolerances stay below {:.0f} °C in air of {:.0f} °C, however "
                    "little current is allowed; use a lower --confidence or --ambient, or {}",
                    motor_.id, 100.0 * options_.guarantee.required_share, reachable_.limits.winding_C, reachable_.hottest_ambient_C,
                    motor_.fit ? "calibrate the motor with more or longer runs, which narrow its intervals" : "calibrate the motor")};
  }

 private:
  /// Throws too_hot() if the motor exceeds its limits without current at most speeds.
  Attempt attempt(double reserve) {
    Observer observer(network_, motor_.nominal, robot_, reserve);
    BarrierRules rules = reachable_;
    rules.most_speed_rad_per_s = sustainable_speed_rad_per_s(observer, reachable_);
    if (rules.most_speed_rad_per_s < reachable_.most_speed_rad_per_s) {
      rules.no_current_speed_rad_per_s.reset();
    }
    constexpr double kLeastShare = 0.2;
    if (rules.most_speed_rad_per_s < kLeastShare * reachable_.most_speed_rad_per_s) {
      throw too_hot();
    }
    CurrentTable table = current_table(observer, rules, options_.table);
    std::vector<LoadPattern> patterns = hardest_patterns(observer, rules);
    const std::size_t count = patterns.size();
    expect_work(count);
    return {reserve, std::move(observer), rules, std::move(table), std::move(patterns), std::vector<std::optional<UsePlayed>>(count)};
  }

  /// Expects that each stage simulates every motor in every use about once; of later attempts few motors are unknown.
  void expect_work(std::size_t uses) {
    const std::size_t once = uses * static_cast<std::size_t>(options_.guarantee.samples);
    if (work_.expected(SearchWork::final_check) == 0) {
      work_.expect(SearchWork::factor_of_search, once + kUsualAttempts * kAttempt);
      work_.expect(SearchWork::factor_of_promise, once + kUsualAttempts * kAttempt);
      work_.expect(SearchWork::final_check, once);
      if (options_.sensor) {
        expect_sensor_work(work_, motor_, reachable_, options_.period_s, uses, options_.guarantee.samples);
      }
    }
    work_.add(kAttempt);
  }

  [[nodiscard]] MotorVerdicts::Simulated simulated() {
    return [this](std::size_t motors) { work_.add(motors); };
  }

  /// Throws too_hot() if the observer itself exceeds its limit: with a temperature-dependent law a node may heat again before it reaches
  /// the temperature at which it would cool.
  const UsePlayed& kept(const Attempt& with, const UsePlayed& played) const {
    constexpr double kRounding_K = 0.5;
    return played.winding_peak_C > with.rules.limits.winding_C + kRounding_K ? throw too_hot() : played;
  }

  /// Plays the uses that are not played yet.
  void play_uses(Attempt& with) const {
    std::vector<std::size_t> missing;
    for (std::size_t index = 0; index < with.uses.size(); ++index) {
      if (!with.uses[index]) {
        missing.push_back(index);
      }
    }
    base::in_parallel((missing.size() + base::kLanes - 1) / base::kLanes, options_.guarantee.threads, [&](std::size_t block) {
      const std::span<const std::size_t> rest = std::span(missing).subspan(block * base::kLanes);
      const std::span<const std::size_t> own = rest.first(std::min<std::size_t>(rest.size(), base::kLanes));
      std::vector<LoadPattern> patterns;
      std::ranges::transform(own, std::back_inserter(patterns), [&](std::size_t index) { return with.patterns[index]; });
      std::vector<UsePlayed> played = play(with.observer, with.table, with.rules, motor_, robot_, patterns, options_.period_s);
      for (std::size_t i = 0; i < own.size(); ++i) {
        with.uses[own[i]] = std::move(played[i]);
      }
    });
  }

  [[nodiscard]] std::vector<UsePlayed> all_uses(Attempt& with) const {
    play_uses(with);
    std::vector<UsePlayed> uses;
    std::ranges::transform(with.uses, std::back_inserter(uses), [&](const std::optional<UsePlayed>& each) { return kept(with, *each); });
    return uses;
  }

  /// Nearly always all uses are needed.
  const UsePlayed& use(Attempt& with, std::size_t index) const {
    if (!with.uses[index]) {
      play_uses(with);
    }
    return kept(with, *with.uses[index]);
  }

  // Each of the two searches makes this many attempts, and an attempt takes as long as this many simulations (motors of the database).
  static constexpr std::size_t kUsualAttempts = 5;
  static constexpr std::size_t kAttempt = 300;

  /// Returns the smallest safety factor, at least `from`, at which at most `most_over` motors exceed a limit. Throws too_hot() if there is
  /// none.
  [[nodiscard]] double smallest(double from, double growth, MotorVerdicts& motors, int most_over) {
    const auto check = [&](double tried) -> TriedFactor {
      // The search has played the uses of its result already.
      Attempt with = last_ && last_->safety_factor == tried ? std::move(*last_) : attempt(tried);
      const auto played = [&](std::size_t index) -> const UsePlayed& { return use(with, index); };
      const int over = motors.count_over(tried, with.patterns, played);
      if (over <= most_over) {
        last_.emplace(std::move(with));
      }
      return {over <= most_over, motors.expected_ratio(most_over)};
    };
    const std::optional<double> found = smallest_factor({from, kLargestReserve, growth}, check);
    return found ? *found : throw too_hot();
  }

  const motor::Motor& motor_;
  const robot::Robot& robot_;
  const DerateOptions& options_;
  BarrierRules reachable_;
  SearchWork& work_;
  thermal::Network network_;
  std::optional<Attempt> last_;  ///< last attempt that was sufficient
};

}  // namespace

std::vector<ActingEffect> acting_effects(const thermal::Network& network, const motor::Motor& motor) {
  const std::vector<double> values = network.values();
  std::vector<ActingEffect> all;
  for (const thermal::EffectInPlace& effect : network.effects()) {
    const auto own = std::ranges::find(motor.effects, effect.name, &motor::MotorEffect::name);
    ActingEffect acting{effect.name,
                        std::string(effect.type->name),
                        std::string(effect.type->equation),
                        own == motor.effects.end() ? std::string() : own->column,
                        {},
                        {}};
    for (const int node : effect.node_index) {
      acting.nodes.emplace_back(network.node_name(node));
    }
    const std::vector<base::ParameterSpec>& specs = effect.type->parameters;
    std::vector<double> own_values;
    for (const int index : effect.parameter_index) {
      own_values.push_back(values[static_cast<std::size_t>(index)]);
    }
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const bool is_choice = !specs[i].choices.empty();
      acting.parameters.push_back({std::string(specs[i].key), std::string(base::unit_of(specs, i, own_values)), own_values[i],
                                   is_choice ? std::string(specs[i].choices[static_cast<std::size_t>(own_values[i])].name) : ""});
    }
    all.push_back(std::move(acting));
  }
  return all;
}

long least_samples(const GuaranteeOptions& options) { return base::fewest_draws(1.0 - options.required_share, kCertainty_share); }

double limp_current_A(const Derating& derating) {
  double least_A = std::numeric_limits<double>::infinity();
  for (const UsePlayed& each : derating.uses) {
    if (each.use.on_s == 0.0 && !each.current_A.empty()) {
      least_A = std::min(least_A, each.current_A.back());
    }
  }
  return std::isinf(least_A) ? 0.0 : least_A;
}

Derating derate(const motor::Motor& as_written, const robot::Robot& robot, const DerateOptions& options, const base::Progress& progress) {
  require_samples(options.guarantee);
  const motor::Motor motor = motor::with_default_spreads(as_written);
  SearchWork work(progress);
  Search search(motor, robot, options, work);
  Search::Promise promise = search.promise(search.reserve());
  Derating result{.motor_id = motor.id,
                  .robot_id = robot.id,
                  .data_quality = std::string(motor::data_quality(motor)),
                  .torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A,
                  .observer = std::move(promise.observer),
                  .rules = promise.rules,
                  .table = std::move(promise.table),
                  .options = options,
                  .assumed = motor.assumed,
                  .effects = acting_effects(search.network(), motor),
                  .guarantee = promise.guarantee,
                  .uses = std::move(promise.uses),
                  .reachable_speed_rad_per_s = search.reachable().most_speed_rad_per_s,
                  .default_spreads = motor::default_spreads(as_written),
                  .doubtful_values = motor::doubtful_values(as_written),
                  .measured_power = motor::measured_power(motor),
                  .unmodelled_heat_share = motor.fit ? motor.fit->unmodelled_heat_share : std::nullopt,
                  .fit_conditions = motor::unstated_fit_conditions(motor),
                  .is_brushless = motor.type != "brushed",
                  .heating_current_ratio = robot::heating_factor(robot),
                  .nominal = motor.nominal,
                  .provenance = {}};
  require_own_friction(result);
  if (options.sensor) {
    result.sensor = plan_sensor(as_written, robot, result, *options.sensor, &work);
  }
  return result;
}

}  // namespace heatsoak::derate
