#include "derate/derating.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/diagnostic.h"
#include "derate/sensed/sensor_plan.h"
#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "thermal/ensemble.h"

namespace heatsoak {
namespace {

constexpr double kLargestReserve = 16.0;
constexpr double kReserveTolerance = 0.01;
/// Streams of chance of the search and of each check, apart from each other.
constexpr std::uint64_t kStreamsApart = std::uint64_t{1} << 32U;

/// Of a full battery; a robot that gives none has its nominal voltage always.
double full_V(const Robot& robot) {
  return std::isnan(robot.battery_full_V) ? robot.battery_V : std::max(robot.battery_V, robot.battery_full_V);
}

}  // namespace

BarrierRules barrier_rules(const Motor& motor, const Robot& robot, const DerateOptions& options) {
  const MotorValues& values = motor.nominal;
  const double loop_ohm = values.terminal_resistance_ohm + robot.series_resistance_ohm();
  BarrierRules rules;
  rules.limits.winding_C = values.winding_limit_C;
  if (!std::isnan(values.stator_limit_C)) {
    rules.limits.stator_C = values.stator_limit_C;
  }
  rules.approach_s = options.approach_s;
  // The stator must not come near its limit faster than a winding without current can let go of it.
  constexpr double kWindingTimes = 3.0;
  rules.stator_approach_s = std::max(options.approach_s, kWindingTimes * values.thermal_time_constant_winding_s);
  rules.hottest_ambient_C = options.hottest_ambient_C;
  // Braking at full speed the back-EMF adds to the supply.
  rules.most_current_A = std::min(robot.current_limit_A, 2.0 * robot.available_V() / loop_ohm);
  constexpr double kPushed = 1.1;  // a robot that is pushed may turn its motors faster than its battery can
  rules.most_speed_rad_per_s = kPushed * std::min(full_V(robot), robot.voltage_limit_V) / values.torque_constant_Nm_per_A;
  // A driver whose command is limited can still be asked for the whole battery by other firmware.
  rules.no_current_speed_rad_per_s =
      std::max(kSpeedFadeOut_ratio * rules.most_speed_rad_per_s, kPushed * full_V(robot) / values.torque_constant_Nm_per_A);
  rules.most_vehicle_speed_m_per_s = rules.most_speed_rad_per_s / robot.gear_ratio * robot.wheel_radius_m;
  return rules;
}

namespace {

void require_short_period(const Network& network, const BarrierRules& rules, const DerateOptions& options) {
  std::vector<Lanes> parameters;
  for (const double value : network.values()) {
    parameters.emplace_back(Lanes::Constant(value));
  }
  OperatingPoint<Lanes> at;
  at.ambient_C = Lanes::Constant(options.hottest_ambient_C);
  at.current_rms_A = Lanes::Constant(rules.most_current_A);
  // A speed is believed up to less than this (belief.cpp).
  const double fastest_rad_per_s = std::max(2.0 * rules.most_speed_rad_per_s, rules.no_current_speed_rad_per_s);
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = Lanes::Constant(fastest_rad_per_s);
  const double longest_s = 0.2 * longest_step_s(network, parameters, at, rules.limits.winding_C - options.hottest_ambient_C);
  if (options.period_s > longest_s || options.period_s > 0.1 * options.approach_s) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a period of {:.3g} s is too long: expected at most {:.3g} s, a twentieth of this motor's "
                              "fastest time constant and a tenth of --approach",
                              options.period_s, std::min(longest_s, 0.1 * options.approach_s)));
  }
}

/// Without a single one over the limit, this many are needed to rule out more of them with 95 % (Hanley and Lippman-Hand 1983).
void require_samples(const GuaranteeOptions& options) {
  const auto least = static_cast<int>(std::ceil(3.0 / (1.0 - options.confidence) * (1.0 - 1e-9)));
  if (options.samples < least) {
    throw Failure(ExitCode::bad_input, fmt::format("{} samples cannot show a confidence of {:.4g}: expected --samples {} or more",
                                                   options.samples, options.confidence, least));
  }
}

/// One reserve with what follows from it.
struct Attempt {
  Observer observer;
  BarrierRules rules;
  CurrentTable table;
  std::vector<UsePlayed> uses;
};

class Search {
 public:
  Search(const Motor& motor, const Robot& robot, const DerateOptions& options, const Progress& progress)
      : motor_(motor),
        robot_(robot),
        options_(options),
        reachable_(barrier_rules(motor, robot, options)),
        progress_(progress),
        network_(datasheet_network(motor, nominal_sample(motor))) {
    require_short_period(network_, reachable_, options);
  }

  [[nodiscard]] const Network& network() const { return network_; }
  [[nodiscard]] const BarrierRules& reachable() const { return reachable_; }

  /// Nothing where limits are passed without current at most of the speeds.
  [[nodiscard]] std::optional<Attempt> attempt(double reserve) const {
    Observer observer(network_, motor_.nominal, robot_, reserve);
    BarrierRules rules = reachable_;
    rules.most_speed_rad_per_s = bearable_speed_rad_per_s(observer, reachable_);
    if (rules.most_speed_rad_per_s < reachable_.most_speed_rad_per_s) {
      rules.no_current_speed_rad_per_s = 0.0;
    }
    constexpr double kLeastShare = 0.2;
    if (rules.most_speed_rad_per_s < kLeastShare * reachable_.most_speed_rad_per_s) {
      return std::nullopt;
    }
    CurrentTable table = current_table(observer, rules, options_.table);
    const std::vector<Use> patterns = hardest_uses(observer, rules);
    std::vector<UsePlayed> uses(patterns.size());
    in_parallel(uses.size(), options_.guarantee.threads,
                [&](std::size_t i) { uses[i] = play(observer, table, rules, motor_, robot_, patterns[i], options_.period_s); });
    // A law over the temperature of a body may heat it again before it is as hot as it would have to be to cool.
    constexpr double kRounding_K = 0.5;
    if (std::ranges::any_of(uses, [&](const UsePlayed& use) { return use.winding_peak_C > rules.limits.winding_C + kRounding_K; })) {
      return std::nullopt;
    }
    return Attempt{std::move(observer), rules, std::move(table), std::move(uses)};
  }

  /// Of motors from that stream of chance on.
  [[nodiscard]] Guarantee checked(const Attempt& attempt, std::uint64_t first_stream) const {
    return check(motor_, reachable_.limits, attempt.uses, options_.guarantee, first_stream);
  }

  [[nodiscard]] bool keeps(const Guarantee& found) const { return found.over <= (1.0 - options_.guarantee.confidence) * found.samples; }

  /// The smallest reserve with which enough of the search's motors keep their limits.
  double reserve() {
    if (is_enough(1.0)) {
      return 1.0;
    }
    double low = 1.0;
    double high = 1.5;
    while (!is_enough(high)) {
      low = high;
      high *= 1.5;
      if (high > kLargestReserve) {
        throw too_hot();
      }
    }
    while (high > low * (1.0 + kReserveTolerance)) {
      const double middle = 0.5 * (low + high);
      (is_enough(middle) ? high : low) = middle;
    }
    return high;
  }

  [[nodiscard]] Failure too_hot() const {
    return {
        ExitCode::limit_exceeded,
        fmt::format("{}: fewer than {:.0f} % of the motors with the declared tolerances keep below {:.0f} °C in air of {:.0f} °C, however "
                    "little current is allowed; use a lower --confidence or --ambient, or calibrate the motor",
                    motor_.id, 100.0 * options_.guarantee.confidence, reachable_.limits.winding_C, reachable_.hottest_ambient_C)};
  }

 private:
  /// A reserve with which the motor passes its limits by itself is none.
  bool is_enough(double reserve) {
    const std::optional<Attempt> tried = attempt(reserve);
    if (progress_) {
      progress_(std::min(++rounds_, kRounds), kRounds + 2);
    }
    if (!tried) {
      throw too_hot();
    }
    return keeps(checked(*tried, 0));
  }

  static constexpr std::size_t kRounds = 10;

  const Motor& motor_;
  const Robot& robot_;
  const DerateOptions& options_;
  BarrierRules reachable_;
  const Progress& progress_;
  Network network_;
  std::size_t rounds_ = 0;
};

}  // namespace

double limp_current_A(const Derating& derating) {
  double least_A = std::numeric_limits<double>::infinity();
  for (const UsePlayed& each : derating.uses) {
    if (each.use.on_s == 0.0 && !each.current_A.empty()) {
      least_A = std::min(least_A, each.current_A.back());
    }
  }
  return std::isinf(least_A) ? 0.0 : least_A;
}

Derating derate(const Motor& as_written, const Robot& robot, const DerateOptions& options, const Progress& progress) {
  require_samples(options.guarantee);
  const Motor motor = with_default_spreads(as_written);
  Search search(motor, robot, options, progress);
  double reserve = search.reserve();
  constexpr double kRaise = 1.005;
  constexpr int kMostRaises = 20;
  for (int number = 1; number <= kMostRaises; ++number, reserve *= kRaise) {
    std::optional<Attempt> tried = search.attempt(reserve);
    if (!tried) {
      throw search.too_hot();
    }
    const Guarantee guarantee = search.checked(*tried, static_cast<std::uint64_t>(number) * kStreamsApart);
    if (!search.keeps(guarantee)) {
      continue;
    }
    Derating result{.motor_id = motor.id,
                    .robot_id = robot.id,
                    .data_quality = std::string(data_quality(motor)),
                    .torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A,
                    .observer = std::move(tried->observer),
                    .rules = tried->rules,
                    .table = std::move(tried->table),
                    .options = options,
                    .assumed = motor.assumed,
                    .effects = {},
                    .guarantee = guarantee,
                    .uses = std::move(tried->uses),
                    .reachable_speed_rad_per_s = search.reachable().most_speed_rad_per_s,
                    .default_spreads = default_spreads(as_written),
                    .is_brushless = motor.type != "brushed",
                    .heating_current_ratio = heating_factor(robot),
                    .nominal = motor.nominal,
                    .provenance = {}};
    for (const EffectInPlace& effect : search.network().effects()) {
      const auto own = std::ranges::find(motor.effects, effect.name, &MotorEffect::name);
      result.effects.push_back({effect.name, std::string(effect.type->name), std::string(effect.type->equation),
                                own == motor.effects.end() ? std::string() : own->column});
    }
    if (options.sensor) {
      result.sensor = plan_sensor(as_written, robot, result, *options.sensor, progress);
    }
    return result;
  }
  throw Failure(ExitCode::numerics_failed, fmt::format("{}: no reserve of heat up to {:.2f} held on motors that its search had not seen; "
                                                       "take more --samples",
                                                       motor.id, reserve));
}

}  // namespace heatsoak
