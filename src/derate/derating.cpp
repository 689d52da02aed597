#include "derate/derating.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "thermal/ensemble.h"

namespace heatsoak {
namespace {

constexpr double kLargestReserve = 16.0;
constexpr double kReserveTolerance = 0.01;
/// Streams of chance of the search and of each check, apart from each other.
constexpr std::uint64_t kStreamsApart = std::uint64_t{1} << 32U;

BarrierRules rules_of(const Motor& motor, const Robot& robot, const DerateOptions& options) {
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
  rules.most_speed_rad_per_s = kPushed * robot.available_V() / values.torque_constant_Nm_per_A;
  return rules;
}

void require_short_period(const Network& network, const BarrierRules& rules, const DerateOptions& options) {
  std::vector<Lanes> parameters;
  for (const double value : network.values()) {
    parameters.emplace_back(Lanes::Constant(value));
  }
  OperatingPoint<Lanes> at;
  at.ambient_C = Lanes::Constant(options.hottest_ambient_C);
  at.current_rms_A = Lanes::Constant(rules.most_current_A);
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = Lanes::Constant(rules.most_speed_rad_per_s);
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

class Search {
 public:
  Search(const Motor& motor, const Robot& robot, const DerateOptions& options, const BarrierRules& rules, const Progress& progress)
      : motor_(motor),
        robot_(robot),
        options_(options),
        rules_(rules),
        progress_(progress),
        network_(datasheet_network(motor, nominal_sample(motor))) {}

  [[nodiscard]] const Network& network() const { return network_; }
  [[nodiscard]] Observer observer(double reserve) const { return {network_, motor_.nominal, robot_, reserve}; }

  [[nodiscard]] std::vector<UsePlayed> play_all(const Observer& observer, const CurrentTable& table, double period_s) const {
    std::vector<UsePlayed> uses(hardest_uses().size());
    in_parallel(uses.size(), options_.guarantee.threads,
                [&](std::size_t i) { uses[i] = play(observer, table, rules_, motor_, robot_, hardest_uses()[i], period_s); });
    return uses;
  }

  /// Whether enough of the search's motors keep their limits with it.
  [[nodiscard]] bool is_enough(double reserve) {
    const Observer with_reserve = observer(reserve);
    const CurrentTable table = current_table(with_reserve, rules_);
    const std::vector<UsePlayed> uses = play_all(with_reserve, table, options_.period_s);
    const Guarantee found = check(motor_, rules_.limits, uses, options_.guarantee, 0);
    if (progress_) {
      progress_(std::min(++rounds_, kRounds), kRounds + 2);
    }
    return keeps(found);
  }

  [[nodiscard]] bool keeps(const Guarantee& found) const { return found.over <= (1.0 - options_.guarantee.confidence) * found.samples; }

  /// The smallest that is enough.
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
        throw Failure(
            ExitCode::limit_exceeded,
            fmt::format("{}: fewer than {:.0f} % of the motors with the declared tolerances keep below {:.0f} °C in air of {:.0f} °C, "
                        "however little current is allowed; use a lower --confidence or --ambient, or calibrate the motor",
                        motor_.id, 100.0 * options_.guarantee.confidence, rules_.limits.winding_C, rules_.hottest_ambient_C));
      }
    }
    while (high > low * (1.0 + kReserveTolerance)) {
      const double middle = 0.5 * (low + high);
      (is_enough(middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  static constexpr std::size_t kRounds = 10;

  const Motor& motor_;
  const Robot& robot_;
  const DerateOptions& options_;
  const BarrierRules& rules_;
  const Progress& progress_;
  Network network_;
  std::size_t rounds_ = 0;
};

}  // namespace

Derating derate(const Motor& motor, const Robot& robot, const DerateOptions& options, const Progress& progress) {
  require_samples(options.guarantee);
  const BarrierRules rules = rules_of(motor, robot, options);
  Search search(motor, robot, options, rules, progress);
  require_short_period(search.network(), rules, options);
  double reserve = search.reserve();
  constexpr double kRaise = 1.005;
  constexpr int kMostRaises = 20;
  for (int attempt = 1; attempt <= kMostRaises; ++attempt, reserve *= kRaise) {
    Observer observer = search.observer(reserve);
    CurrentTable table = current_table(observer, rules);
    std::vector<UsePlayed> uses = search.play_all(observer, table, options.period_s);
    const Guarantee guarantee = check(motor, rules.limits, uses, options.guarantee, static_cast<std::uint64_t>(attempt) * kStreamsApart);
    if (!search.keeps(guarantee)) {
      continue;
    }
    Derating result{.motor_id = motor.id,
                    .robot_id = robot.id,
                    .data_quality = std::string(data_quality(motor)),
                    .torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A,
                    .observer = std::move(observer),
                    .rules = rules,
                    .table = std::move(table),
                    .options = options,
                    .effects = {},
                    .guarantee = guarantee,
                    .uses = std::move(uses)};
    for (const EffectInPlace& effect : search.network().effects()) {
      result.effects.push_back({effect.name, std::string(effect.type->name), std::string(effect.type->equation)});
    }
    return result;
  }
  throw Failure(ExitCode::numerics_failed, fmt::format("{}: no reserve of heat up to {:.2f} held on motors that its search had not seen; "
                                                       "take more --samples",
                                                       motor.id, reserve));
}

}  // namespace heatsoak
