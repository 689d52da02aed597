#include "derate/sensed/sensor_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/diagnostic.h"
#include "derate/sensed/closed_loop.h"
#include "derate/sensed/kalman_design.h"
#include "derate/sensed/sensor_fault.h"
#include "derate/smallest_factor.h"
#include "select/spread.h"

namespace heatsoak::derate {
namespace {

/// Simulation steps per approach_s of the search and of the check. A longer step holds the current longer, which heats more.
constexpr double kStepsPerApproach = 10.0;
constexpr double kCheckStepsPerApproach = 30.0;
/// Usual attempts of search and check, motors that take as long as the sensor fault, and simulations without a sensor that a step of one
/// with a sensor takes as long as.
constexpr std::size_t kUsualSearches = 8;
constexpr std::size_t kUsualChecks = 3;
constexpr std::size_t kFaultMotors = 280;
constexpr double kSimulationsPerStep = 1e-3;

double coarse_step_s(const BarrierRules& rules, double period_s) { return std::max(period_s, rules.approach_s / kStepsPerApproach); }
double fine_step_s(const BarrierRules& rules, double period_s) {
  return std::max(2.0 * period_s, rules.approach_s / kCheckStepsPerApproach);
}

/// Returns the work of this many simulations with a sensor.
std::size_t sensed_work(const motor::Motor& motor, double step_s, std::size_t simulations) {
  return static_cast<std::size_t>(kSimulationsPerStep * use_duration_s(motor.nominal) / step_s * static_cast<double>(simulations));
}

/// Offset between the random streams of the search, which are those of the guard without a sensor, and those of the check.
constexpr std::uint64_t kStreamsApart = std::uint64_t{1} << 32U;
/// Exponent of winding_speed_ratio over the ratio of safety factors. A pulse from cold heats the winding in proportion to safety factor
/// times winding_speed_ratio. With an exponent of 1 that product is the same as without a sensor, and pulses determine the safety factor.
/// With 2 the winding is so fast that the steady state gains nothing more (found on motors drawn for the ECX FLAT 32 L).
constexpr double kPulseExponent = 1.5;

/// Returns the nominal motor with the winding's heat capacity divided by the ratio.
thermal::Network faster_network(const motor::Motor& motor, double winding_speed_ratio) {
  motor::MotorSample sample = motor::nominal_sample(motor);
  sample.values.thermal_time_constant_winding_s /= winding_speed_ratio;
  return motor::datasheet_network(motor, sample);
}

ReadingCheck first_check(const SensorOptions& options) {
  constexpr double kColdMargin_K = 5.0;  // an air sensor has an error too
  constexpr double kFrozenBand = 0.25;
  return {.most_C = 300.0, .cold_share = 0.0, .cold_margin_K = kColdMargin_K, .frozen_band_K = kFrozenBand * options.accuracy_K};
}

class PlanSearch {
 public:
  PlanSearch(const motor::Motor& motor, const robot::Robot& robot, const Derating& model_only, const SensorOptions& options,
             SearchWork* work)
      : motor_(motor),
        robot_(robot),
        model_only_(model_only),
        options_(options),
        work_(work),
        uses_(hardest_patterns(model_only.observer, model_only.rules)) {
    const SensorGain gain = sensor_gain(motor, robot, model_only.rules, options, model_only.options.period_s, limp_current_A(model_only),
                                        model_only.options.guarantee.samples, model_only.options.guarantee.seed);
    gain_ = gain.gain;
    lag_gain_ratio_ = gain.lag_gain_ratio;
  }

  [[nodiscard]] SensorPlan plan_with(double reserve) const {
    const double winding_speed_ratio = std::pow(std::max(1.0, model_only_.observer.heat_safety_factor() / reserve), kPulseExponent);
    Observer observer(faster_network(motor_, winding_speed_ratio), motor_.nominal, robot_, reserve);
    CurrentTable table = current_table(observer, model_only_.rules, model_only_.options.table);
    SensorPlan plan{.options = options_,
                    .observer = std::move(observer),
                    .winding_speed_ratio = winding_speed_ratio,
                    .table = std::move(table),
                    .gain = gain_,
                    .lag_gain_ratio = lag_gain_ratio_,
                    .check = first_check(options_)};
    if (options_.kind == SensorKind::winding_resistance) {
      plan.resistance = resistance_reading(motor_, options_, model_only_.options.period_s);
    }
    return plan;
  }

  [[nodiscard]] SensedLoop loop(const SensorPlan& plan, double step_s) const {
    return {motor_, robot_, model_only_.rules, model_only_.observer, model_only_.table, plan, model_only_.options.period_s, step_s};
  }

  [[nodiscard]] std::vector<SensedPeak> peaks(const SensorPlan& plan, double step_s, std::uint64_t first_stream) const {
    const GuaranteeOptions& options = model_only_.options.guarantee;
    const SensedLoop sensed = loop(plan, step_s);
    const auto blocks = static_cast<std::size_t>((options.samples + base::kLanes - 1) / base::kLanes);
    std::vector<SensedPeak> all(blocks * base::kLanes);
    const std::size_t per_block = sensed_work(motor_, step_s, base::kLanes * uses_.size());
    const base::Progress progress = work_ ? [&](std::size_t, std::size_t) { work_->add(per_block); } : base::Progress();
    base::in_parallel(blocks, options.threads, 0, blocks, progress, [&](std::size_t block) {
      const auto found = sensed_peaks(sensed, uses_, options.seed, first_stream + block * base::kLanes);
      std::ranges::copy(found, all.begin() + static_cast<std::ptrdiff_t>(block * base::kLanes));
    });
    all.resize(static_cast<std::size_t>(options.samples));
    return all;
  }

  /// Returns the smallest safety factor at which the share of the search's motors that keep their limits reaches the confidence; nothing if
  /// none below the factor without a sensor does.
  [[nodiscard]] std::optional<double> reserve() {
    constexpr double kGrowth = 1.15;
    const double coarse_s = coarse_step_s(model_only_.rules, model_only_.options.period_s);
    begin(SearchWork::sensor_search);
    return smallest(1.0, kGrowth, [&](double tried) {
      const Guarantee found = guarantee_of(peaks(plan_with(tried), coarse_s, 0));
      return found.over <= (1.0 - model_only_.options.guarantee.required_share) * found.samples;
    });
  }

  /// Plan whose check on fresh motors shows the confidence, and the extremes of these motors.
  struct Promise {
    SensorPlan plan;
    std::vector<SensedPeak> peaks;
  };
  /// Returns the plan with the smallest safety factor, at least `from`, at which the lower bound on fresh motors reaches the confidence.
  /// All attempts use the same motors, as without a sensor, so that the confidence level is that of a single check.
  [[nodiscard]] std::optional<Promise> promise(double from) {
    constexpr double kGrowth = 1.02;
    std::optional<Promise> made;
    begin(SearchWork::sensor_promise);
    const std::optional<double> found = smallest(from, kGrowth, [&](double tried) {
      SensorPlan plan = plan_with(tried);
      std::vector<SensedPeak> fresh = peaks(plan, fine_s(), kStreamsApart);
      plan.guarantee = guarantee_of(fresh);
      const bool holds = plan.guarantee.over <= most_over(model_only_.options.guarantee);
      if (holds) {
        made.emplace(Promise{std::move(plan), std::move(fresh)});
      }
      return holds;
    });
    return found ? std::move(made) : std::nullopt;
  }

  /// Simulation step of the check in s.
  [[nodiscard]] double fine_s() const { return fine_step_s(model_only_.rules, model_only_.options.period_s); }

  void begin(SearchWork::Stage stage) const {
    if (work_) {
      work_->begin(stage);
    }
  }

  [[nodiscard]] const std::vector<LoadPattern>& uses() const { return uses_; }

 private:
  static Guarantee guarantee_of(std::span<const SensedPeak> sensed) {
    const std::vector<MotorPeak> plain(sensed.begin(), sensed.end());
    return guarantee(plain);
  }

  template <class IsEnough>
  [[nodiscard]] std::optional<double> smallest(double from, double growth, const IsEnough& is_enough) {
    const auto check = [&](double tried) { return TriedFactor{.is_enough = is_enough(tried)}; };
    return smallest_factor({from, model_only_.observer.heat_safety_factor(), growth}, check);
  }

  const motor::Motor& motor_;
  const robot::Robot& robot_;
  const Derating& model_only_;
  const SensorOptions& options_;
  SearchWork* work_;
  std::vector<LoadPattern> uses_;
  std::vector<double> gain_;
  double lag_gain_ratio_ = 0.0;
};

/// Sets bounds that at most about 1 % of the correct sensors violate.
void set_check(SensorPlan& plan, std::span<const SensedPeak> peaks) {
  constexpr double kFalse = 0.01;
  constexpr double kFrozenMargin = 1.5;
  constexpr double kRateMargin = 1.5;
  std::vector<double> cold;
  std::vector<double> frozen;
  double rate_K_per_s = 0.0;
  for (const SensedPeak& each : peaks) {
    cold.push_back(each.cold_share);
    frozen.push_back(each.frozen_K);
    rate_K_per_s = std::max(rate_K_per_s, each.rate_K_per_s);
  }
  std::ranges::sort(cold);
  std::ranges::sort(frozen);
  ReadingCheck& check = plan.check;
  check.cold_share = select::quantile(cold, kFalse);
  check.frozen_K = kFrozenMargin * select::quantile(frozen, 1.0 - kFalse);
  check.most_rate_K_per_s = kRateMargin * rate_K_per_s;
  check.most_jump_K = 2.0 * plan.options.accuracy_K;
  plan.dropped = static_cast<int>(std::ranges::count_if(
      peaks, [&](const SensedPeak& each) { return each.cold_share < check.cold_share || each.frozen_K > check.frozen_K; }));
}

/// Sets the continuous currents of the continuous uses in the plain case, which come first.
void set_lasting(SensorPlan& plan, const SensedLoop& loop, const Derating& model_only) {
  for (const UsePlayed& each : model_only.uses) {
    if (each.use.on_s > 0.0) {
      break;
    }
    const double without_A = each.current_A.back();
    plan.lasting.push_back({each.use.speed_share * model_only.rules.most_speed_rad_per_s, without_A,
                            std::min(nominal_lasting_current_A(loop, each.use), without_A + plan.most_gain_A)});
  }
}

void require_sensible(const Observer& observer, const SensorOptions& options) {
  if (!(options.accuracy_K > 0.0)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("a sensor accuracy of {:.3g} K: expected more than 0 K", options.accuracy_K));
  }
  if (options.node < 0 || static_cast<std::size_t>(options.node) >= observer.state_count()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("sensor at node {}: expected a node below {}", options.node, observer.state_count()));
  }
}

}  // namespace

void expect_sensor_work(SearchWork& work, const motor::Motor& motor, const BarrierRules& rules, double period_s, std::size_t uses,
                        int samples) {
  const std::size_t all = uses * static_cast<std::size_t>(samples);
  work.expect(SearchWork::sensor_search, kUsualSearches * sensed_work(motor, coarse_step_s(rules, period_s), all));
  work.expect(SearchWork::sensor_promise, kUsualChecks * sensed_work(motor, fine_step_s(rules, period_s), all));
  work.expect(SearchWork::sensor_fault, sensed_work(motor, fine_step_s(rules, period_s), uses * kFaultMotors));
}

SensorPlan plan_sensor(const motor::Motor& as_written, const robot::Robot& robot, const Derating& model_only, const SensorOptions& options,
                       SearchWork* work) {
  require_sensible(model_only.observer, options);
  const motor::Motor motor = motor::with_default_spreads(as_written);
  PlanSearch search(motor, robot, model_only, options, work);
  if (const std::optional<double> reserve = search.reserve()) {
    if (std::optional<PlanSearch::Promise> promise = search.promise(*reserve);
        promise && promise->plan.observer.heat_safety_factor() < model_only.observer.heat_safety_factor()) {
      SensorPlan& plan = promise->plan;
      search.begin(SearchWork::sensor_fault);
      set_check(plan, promise->peaks);
      set_sensor_fault(plan, motor, robot, model_only, search.uses());
      set_lasting(plan, search.loop(plan, search.fine_s()), model_only);
      return std::move(plan);
    }
  }
  throw base::Failure(
      base::ExitCode::cannot_answer,
      fmt::format(
          "{}: a sensor with an error of {:.3g} K does not lower the safety factor on heat; leave it out or use a more accurate one",
          motor.id, options.accuracy_K));
}

}  // namespace heatsoak::derate
