#include "select/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/confidence.h"
#include "base/diagnostic.h"
#include "motor/datasheet_network.h"
#include "motor/default_spread.h"
#include "select/decision.h"
#include "select/drive_profile.h"
#include "select/spread.h"
#include "select/sustainable_current.h"
#include "thermal/ensemble.h"

namespace heatsoak::select {
namespace {

using motor::states::stator;
using motor::states::winding;

constexpr std::size_t kBandCells = 160;
/// Random streams of robots are separate from those of motors, so that all motors are evaluated with the same drawn robots.
constexpr std::uint64_t kRobotStreams = std::uint64_t{1} << 40U;

/// Eight samples that are computed together: their parameters and their operating points in each bin of the duty.
class Block {
 public:
  Block(const motor::Motor& motor, const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& demand,
        const EvaluateOptions& options, int first_sample)
      : kind_(duty.kind), demand_(demand), name_(motor.id) {
    std::vector<thermal::Network> networks;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      base::Random random(options.seed, static_cast<std::uint64_t>(first_sample + lane));
      // The duty is drawn first, so that ambient and load do not depend on the number of motor parameters.
      duties_.push_back(draw_sample(duty, random));
      base::Random of_robot(options.seed, kRobotStreams + static_cast<std::uint64_t>(first_sample + lane));
      robots_.push_back(robot::draw_sample(robot, of_robot));
      motors_.push_back(motor::draw_sample(motor, random));
      networks.push_back(motor::datasheet_network(motor, motors_.back()));
      const std::vector<double> values = networks.back().values();
      parameters_.resize(values.size());
      for (std::size_t p = 0; p < values.size(); ++p) {
        parameters_[p][lane] = values[p];
      }
    }
    network_ = std::move(networks.front());
  }

  /// Calls `visit(time_s, state_C)` at the end of every bin, and between at least every `longest_visit_s`.
  template <class Visit>
  std::vector<thermal::Lanes> peaks(double longest_visit_s, const Visit& visit) const {
    std::vector<thermal::Lanes> start_C(static_cast<std::size_t>(network_.state_count()));
    for (int lane = 0; lane < base::kLanes; ++lane) {
      for (thermal::Lanes& node : start_C) {
        node[lane] = duties_[static_cast<std::size_t>(lane)].ambient_C;
      }
    }
    thermal::EnsembleRun run(network_, parameters_, start_C);
    const double step_s = shortest_of_longest_steps_s();
    double time_s = 0.0;
    for (const duty::LoadBin& bin : demand_.bins) {
      const double parts = std::max(1.0, std::ceil(bin.duration_s / longest_visit_s));
      thermal::OperatingPoint<thermal::Lanes> at = point(bin);
      for (int part = 0; part < static_cast<int>(parts); ++part) {
        run.over(bin.duration_s / parts, at, step_s);
        time_s += bin.duration_s / parts;
        visit(time_s, run.state_C());
      }
    }
    return run.peak_C();
  }

  [[nodiscard]] const robot::Robot& robot(int lane) const { return robots_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] const motor::MotorSample& motor(int lane) const { return motors_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] const DutySample& duty(int lane) const { return duties_[static_cast<std::size_t>(lane)]; }

 private:
  [[nodiscard]] thermal::OperatingPoint<thermal::Lanes> point(const duty::LoadBin& bin) const {
    thermal::OperatingPoint<thermal::Lanes> at;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      const thermal::OperatingPoint<double> one = operating_point(motors_[i].values, robots_[i], kind_, bin, duties_[i]);
      thermal::convert_point([lane](thermal::Lanes& to, const double& from) { to[lane] = from; }, at, one);
    }
    return at;
  }

  /// Returns the step that suits every bin. The network is fastest at the highest current, at the highest speed or at rest.
  [[nodiscard]] double shortest_of_longest_steps_s() const {
    const auto by_current = std::ranges::max_element(
        demand_.bins, {}, [&](const duty::LoadBin& bin) { return std::max(bin.torque_rms_Nm, bin.current_rms_A); });
    const auto by_speed = std::ranges::max_element(demand_.bins, {}, &duty::LoadBin::speed_rms_rad_per_s);
    const double calm_s = thermal::longest_step_s(network_, parameters_, point(duty::constant_bin(1.0, 0.0, 0.0, 0.0)));
    const double shortest_s = demand_.duration_s() / static_cast<double>(thermal::kMostSteps);
    double step_s = calm_s;
    constexpr double kHotter_K = 60.0;
    for (const auto& bin : {by_current, by_speed}) {
      const thermal::OperatingPoint<thermal::Lanes> at = point(*bin);
      step_s = std::min(
          {step_s, thermal::longest_step_s(network_, parameters_, at), thermal::longest_step_s(network_, parameters_, at, kHotter_K)});
    }
    if (calm_s < shortest_s) {
      throw base::Failure(
          base::ExitCode::numerics_failed,
          fmt::format("{}: a duty of {:.0f} s has too many steps for a thermal network with a time constant of {:.2g} s; check "
                      "whether a thermal resistance or a heat capacity is too small",
                      name_, demand_.duration_s(), calm_s));
    }
    if (step_s < shortest_s) {
      // The copper loss grows with the square of the current, and so does the rate at which the network reacts to it.
      const double current_A = point(*by_current).current_rms_A.maxCoeff();
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("{}: the duty drives {:.0f} A through it, which heats the winding by its own heat within {:.2g} s; "
                                      "expected at most about {:.0f} A: check the duty's load and the robot's voltage and current limits",
                                      name_, current_A, step_s, current_A * std::sqrt(step_s / shortest_s)));
    }
    return step_s;
  }

  duty::DutyKind kind_;
  const duty::WheelDemand& demand_;
  const std::string& name_;
  thermal::Network network_;
  std::vector<robot::Robot> robots_;
  std::vector<motor::MotorSample> motors_;
  std::vector<DutySample> duties_;
  std::vector<thermal::Lanes> parameters_;
};

/// Lowest and highest temperature of every sample in every cell of the chart's time grid, [cell][sample]. Values at grid points alone would
/// miss the ripple of an on/off duty.
struct Envelope {
  std::vector<float> low_C, high_C;

  void resize(std::size_t count) {
    low_C.assign(count, std::numeric_limits<float>::max());
    high_C.assign(count, std::numeric_limits<float>::lowest());
  }
  void take(std::size_t place, double value_C) {
    low_C[place] = std::min(low_C[place], static_cast<float>(value_C));
    high_C[place] = std::max(high_C[place], static_cast<float>(value_C));
  }
};

/// Inputs and results of one motor. Threads write the results of samples to separate elements.
struct Work {
  const motor::Motor* motor = nullptr;
  const duty::WheelDemand* wheel = nullptr;  ///< wheel with the hottest winding
  double duration_s = 0.0;                   ///< duration of its demand
  MotorEvaluation result;
  std::vector<double> winding_peak_C, stator_peak_C;  ///< per sample
  std::vector<char> over_limit;                       ///< per sample
  std::vector<robot::DriveLimit> short_of_demand;     ///< limit that causes the shortfall of a sample, or none
  Envelope winding_envelope_C, stator_envelope_C;
};

LimitingFactor limiting_factor_of(robot::DriveLimit limit) {
  return limit == robot::DriveLimit::current ? LimitingFactor::current : LimitingFactor::voltage;
}

/// Nominal run of one wheel with the reference solver.
struct NominalRun {
  std::vector<thermal::Interval> intervals;
  double current_rms_A = 0.0;  ///< RMS of the actual current, which the resistance of the hot winding may limit
  thermal::TransientResult transient;
  TemperatureCurves curves;
};

NominalRun run_nominal(const thermal::Network& network, const motor::MotorSample& sample, const robot::Robot& robot, const duty::Duty& duty,
                       const duty::WheelDemand& demand, const std::vector<thermal::NodeLimit>& limits, bool with_curves) {
  NominalRun run;
  run.intervals = intervals(sample.values, robot, duty.kind, demand, nominal_sample(duty));
  thermal::TransientOptions options;
  options.limits = limits;
  const std::vector<double> parameters = network.values();
  double charge_A2_s = 0.0;
  double last_A2 = 0.0;
  double last_s = 0.0;
  const auto keep = [&](const thermal::TransientMoment& moment) {
    const double flows_A = network.flowing_A(run.intervals[moment.interval].at, parameters.data(), moment.state_C.data());
    if (!moment.begins_interval) {
      charge_A2_s += 0.5 * (last_A2 + flows_A * flows_A) * (moment.time_s - last_s);
    }
    last_A2 = flows_A * flows_A;
    last_s = moment.time_s;
    if (!with_curves) {
      return;
    }
    run.curves.time_s.push_back(moment.time_s);
    run.curves.winding_C.push_back(moment.state_C[winding]);
    run.curves.stator_C.push_back(moment.state_C[stator]);
  };
  run.transient = thermal::run_transient(network, parameters, run.intervals, options, keep);
  run.current_rms_A = last_s > 0.0 ? std::sqrt(charge_A2_s / last_s) : 0.0;
  return run;
}

/// Returns the largest factor on the load, at most `most`, that voltage and driver can deliver with the winding at its limit.
/// Returns `most` if it is at most 1 or if the present load cannot be delivered.
double deliverable_factor(const motor::MotorValues& values, const robot::Robot& robot, const duty::Duty& duty,
                          const duty::WheelDemand& wheel, double most) {
  const auto is_delivered = [&](double factor) {
    DutySample sample = nominal_sample(duty);
    sample.load *= factor;
    return feasibility(values, robot, duty.kind, wheel, sample, values.winding_limit_C).short_time_share <= kTolerableShortTime;
  };
  if (most <= 1.0 || is_delivered(most) || !is_delivered(1.0)) {
    return most;
  }
  constexpr int kBits = 10;
  const auto is_short = [&](double factor) { return is_delivered(factor) ? -1.0 : 1.0; };
  return boost::math::tools::bisect(is_short, 1.0, most, boost::math::tools::eps_tolerance<double>(kBits)).first;
}

void evaluate_nominal(Work& work, const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                      const EvaluateOptions& options) {
  const motor::Motor& motor = *work.motor;
  MotorEvaluation& result = work.result;
  const motor::MotorSample sample = motor::nominal_sample(motor);
  const thermal::Network network = motor::datasheet_network(motor, sample);
  std::vector<thermal::NodeLimit> limits{{winding, sample.values.winding_limit_C}};
  if (sample.values.stator_limit_C) {
    limits.push_back({stator, *sample.values.stator_limit_C});
    result.stator_limit_C = sample.values.stator_limit_C;
  }
  NominalRun run;
  for (const duty::WheelDemand& wheel : wheels) {
    NominalRun candidate = run_nominal(network, sample, robot, duty, wheel, limits, options.with_curves);
    if (!work.wheel || candidate.transient.peak_C[winding] > run.transient.peak_C[winding]) {
      work.wheel = &wheel;
      run = std::move(candidate);
    }
  }
  work.duration_s = work.wheel->duration_s();
  const thermal::TransientResult& transient = run.transient;
  const DutySample demanded = nominal_sample(duty);
  const Feasibility hot = feasibility(sample.values, robot, duty.kind, *work.wheel, demanded,
                                      std::min(transient.peak_C[winding], sample.values.winding_limit_C));
  result.wheel = work.wheel->wheel;
  result.curves = std::move(run.curves);
  result.highest_voltage_V = hot.highest_voltage_V;
  result.short_time_share = hot.short_time_share;
  result.short_limit = limiting_factor_of(hot.limit);
  result.motor_id = motor.id;
  result.data_quality = motor::data_quality(motor);
  result.winding_limit_C = sample.values.winding_limit_C;
  result.winding_peak_C.nominal = transient.peak_C[winding];
  result.stator_peak_C.nominal = transient.peak_C[stator];
  result.destroyed = transient.destroyed;
  result.current_rms_A = run.current_rms_A;
  result.least_torque_share = hot.least_share;
  result.margin_K = result.winding_limit_C - transient.peak_C[winding];
  if (result.stator_limit_C) {
    result.stator_margin_K = *result.stator_limit_C - transient.peak_C[stator];
  }
  if (options.with_current_margin) {
    const bool is_over = result.margin_K < 0.0 || result.stator_margin_K.value_or(0.0) < 0.0;
    if (const std::optional<double> factor = sustainable_current_factor(network, run.intervals, limits, is_over)) {
      const double driven = deliverable_factor(sample.values, robot, duty, *work.wheel, *factor);
      result.margin_A = driven * current_rms_A(run.intervals) - result.current_rms_A;
    }
  }
  std::size_t first_limit = 0;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::optional<double>& time_s = transient.time_to_limit_s[i];
    if (time_s && (!result.time_to_limit_s || *time_s < *result.time_to_limit_s)) {
      result.time_to_limit_s = time_s;
      first_limit = i;
    }
  }
  // `hot` was computed at the peak winding temperature, but not above the limit: a motor over its limit has failed, and is not infeasible.
  if (hot.short_time_share > kTolerableShortTime) {
    result.verdict = Verdict::infeasible;
    result.limiting_factor = limiting_factor_of(hot.limit);
  } else if (result.time_to_limit_s) {
    result.verdict = Verdict::fail;
    result.limiting_factor = first_limit == 0 ? LimitingFactor::winding_temperature : LimitingFactor::stator_temperature;
  }
}

void evaluate_samples(Work& work, const robot::Robot& robot, const duty::Duty& duty, const EvaluateOptions& options, int first_sample) {
  const auto turn = static_cast<std::size_t>(first_sample / base::kLanes);
  const duty::WheelDemand& demand = options.draws.empty() ? *work.wheel : options.draws[turn % options.draws.size()];
  const Block block(*work.motor, robot, duty, demand, options, first_sample);
  const double cell_s = work.duration_s / static_cast<double>(kBandCells);
  const auto samples = static_cast<std::size_t>(options.samples);
  std::size_t cell = 0;
  const auto take = [&](const std::vector<thermal::Lanes>& state_C) {
    for (int lane = 0; lane < base::kLanes && first_sample + lane < options.samples; ++lane) {
      const std::size_t place = cell * samples + static_cast<std::size_t>(first_sample + lane);
      work.winding_envelope_C.take(place, state_C[winding][lane]);
      work.stator_envelope_C.take(place, state_C[stator][lane]);
    }
  };
  const std::vector<thermal::Lanes> peak_C =
      block.peaks(options.with_bands ? cell_s : std::numeric_limits<double>::infinity(),
                  [&](double time_s, const std::vector<thermal::Lanes>& state_C) {
                    if (!options.with_bands || time_s > work.duration_s * (1.0 + 1e-9)) {
                      return;  // the chart ends with the nominal duty; a draw may be longer
                    }
                    take(state_C);
                    while (cell + 1 < kBandCells && time_s >= static_cast<double>(cell + 1) * cell_s * (1.0 - 1e-9)) {
                      ++cell;
                      take(state_C);
                    }
                  });
  for (int lane = 0; lane < base::kLanes && first_sample + lane < options.samples; ++lane) {
    const std::size_t place = static_cast<std::size_t>(first_sample) + static_cast<std::size_t>(lane);
    const motor::MotorValues& values = block.motor(lane).values;
    work.winding_peak_C[place] = peak_C[winding][lane];
    work.stator_peak_C[place] = peak_C[stator][lane];
    const bool is_over =
        peak_C[winding][lane] > values.winding_limit_C || (values.stator_limit_C && peak_C[stator][lane] > *values.stator_limit_C);
    work.over_limit[place] = is_over ? 1 : 0;
    const double hottest_C = std::min(peak_C[winding][lane], values.winding_limit_C);
    const Feasibility each = feasibility(values, block.robot(lane), duty.kind, demand, block.duty(lane), hottest_C);
    work.short_of_demand[place] = each.short_time_share > kTolerableShortTime ? each.limit : robot::DriveLimit::none;
  }
}

/// Returns the percentile over the samples in every time cell. A cell counts only samples that reach it, because draws differ in duration.
std::vector<double> percentile(const std::vector<float>& by_cell, int samples, double share) {
  std::vector<double> result;
  for (auto first = by_cell.begin(); first != by_cell.end(); first += samples) {
    std::vector<double> sorted;
    std::copy_if(first, first + samples, std::back_inserter(sorted),
                 [](float value_C) { return std::abs(value_C) < std::numeric_limits<float>::max(); });
    if (sorted.empty()) {
      break;
    }
    std::ranges::sort(sorted);
    result.push_back(quantile(sorted, share));
  }
  return result;
}

void finish_band(Work& work, int samples) {
  TemperatureCurves& curves = work.result.curves;
  curves.winding_p05_C = percentile(work.winding_envelope_C.low_C, samples, base::kLowPercentile_share);
  curves.winding_p95_C = percentile(work.winding_envelope_C.high_C, samples, base::kHighPercentile_share);
  curves.stator_p05_C = percentile(work.stator_envelope_C.low_C, samples, base::kLowPercentile_share);
  curves.stator_p95_C = percentile(work.stator_envelope_C.high_C, samples, base::kHighPercentile_share);
  for (std::size_t cell = 0; cell < curves.winding_p05_C.size(); ++cell) {
    curves.band_time_s.push_back(work.duration_s * (static_cast<double>(cell) + 0.5) / static_cast<double>(kBandCells));
  }
}

void conclude(Work& work, const EvaluateOptions& options) {
  MotorEvaluation& result = work.result;
  result.samples = options.samples;
  result.games = static_cast<int>(options.draws.size());
  result.winding_peak_C = spread(result.winding_peak_C.nominal, work.winding_peak_C);
  result.stator_peak_C = spread(result.stator_peak_C.nominal, work.stator_peak_C);
  const auto by_voltage = std::ranges::count(work.short_of_demand, robot::DriveLimit::voltage);
  const auto by_current = std::ranges::count(work.short_of_demand, robot::DriveLimit::current);
  if (result.verdict != Verdict::infeasible) {
    result.short_limit = by_current > by_voltage ? LimitingFactor::current : LimitingFactor::voltage;
  }
  if (options.samples > 0) {
    const bool is_drawn = !options.draws.empty();
    result.probability_over_limit = static_cast<double>(std::ranges::count(work.over_limit, char{1})) / options.samples;
    result.short_probability = static_cast<double>(by_voltage + by_current) / options.samples;
    const double wrong = error_share(is_drawn ? result.games : result.samples, is_drawn);
    const auto intervals_of = [&](std::span<const double> peak_C, std::span<const char> flags) {
      return is_drawn ? draw_intervals(peak_C, flags, {options.draws.size(), base::kLanes, options.seed}, wrong)
                      : sample_intervals(peak_C, flags, wrong);
    };
    const DrawIntervals intervals = intervals_of(work.winding_peak_C, work.over_limit);
    result.winding_p95_interval_C = intervals.p95;
    result.stator_p95_interval_C = intervals_of(work.stator_peak_C, work.over_limit).p95;
    result.probability_interval = intervals.probability;
    std::vector<char> is_short;
    std::ranges::transform(work.short_of_demand, std::back_inserter(is_short),
                           [](robot::DriveLimit limit) { return limit == robot::DriveLimit::none ? char{0} : char{1}; });
    result.short_interval = intervals_of(work.winding_peak_C, is_short).probability;
    decide_by_samples(result, is_drawn);
    if (options.with_bands) {
      finish_band(work, options.samples);
    }
  }
}

}  // namespace

void sort_by_verdict(std::vector<MotorEvaluation>& results) { std::ranges::stable_sort(results, ranks_before); }

double nearest_margin_K(const MotorEvaluation& motor) {
  const auto margin_K = [&](double limit_C, const Spread95& peak_C) {
    return limit_C - (motor.games > 0 ? peak_C.p95.value_or(peak_C.nominal) : peak_C.nominal);
  };
  const double of_winding_K = margin_K(motor.winding_limit_C, motor.winding_peak_C);
  return motor.stator_limit_C ? std::min(of_winding_K, margin_K(*motor.stator_limit_C, motor.stator_peak_C)) : of_winding_K;
}

Verdict with_upper(Verdict nominal, Verdict upper) {
  return nominal == Verdict::pass && upper != Verdict::pass ? Verdict::marginal : nominal;
}

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"pass", "marginal", "fail", "infeasible"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

std::string_view to_string(LimitingFactor factor) {
  constexpr std::array<std::string_view, 5> kNames{"none", "winding_temperature", "stator_temperature", "voltage", "current"};
  return kNames.at(static_cast<std::size_t>(factor));
}

int draw_count(const duty::Duty& duty, int samples) {
  return duty.shape_data->has_unknowns() ? (samples + base::kLanes - 1) / base::kLanes : 0;
}

std::vector<duty::WheelDemand> draw_demands(const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count, int threads,
                                            const base::Progress& progress) {
  std::vector<duty::WheelDemand> draws;
  add_draws(draws, duty, robot, seed, count, threads, progress);
  return draws;
}

void add_draws(std::vector<duty::WheelDemand>& draws, const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count,
               int threads, const base::Progress& progress) {
  const std::size_t first = draws.size();
  draws.resize(std::max(first, static_cast<std::size_t>(count)));
  const std::size_t more = draws.size() - first;
  base::in_parallel(more, threads, 0, more, progress,
                    [&](std::size_t i) { draws[first + i] = duty.shape_data->draw(robot, seed, first + i); });
}

std::vector<MotorEvaluation> evaluate(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                                      std::span<const motor::Motor> motors, const EvaluateOptions& options,
                                      const base::Progress& progress) {
  std::vector<motor::Motor> complete;
  std::ranges::transform(motors, std::back_inserter(complete), motor::with_default_spreads);
  return evaluate_as_stated(robot, duty, wheels, complete, options, progress);
}

std::vector<MotorEvaluation> evaluate_as_stated(const robot::Robot& robot, const duty::Duty& duty,
                                                std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                const EvaluateOptions& options, const base::Progress& progress) {
  const auto samples = static_cast<std::size_t>(options.samples);
  const std::size_t blocks = (samples + base::kLanes - 1) / base::kLanes;
  std::vector<Work> works(motors.size());
  for (std::size_t i = 0; i < motors.size(); ++i) {
    works[i].motor = &motors[i];
    works[i].winding_peak_C.resize(samples);
    works[i].stator_peak_C.resize(samples);
    works[i].over_limit.resize(samples);
    works[i].short_of_demand.resize(samples);
    works[i].winding_envelope_C.resize(options.with_bands ? samples * kBandCells : 0);
    works[i].stator_envelope_C.resize(options.with_bands ? samples * kBandCells : 0);
  }
  const std::size_t jobs = motors.size() * blocks;
  const std::size_t all = motors.size() + jobs;
  // The samples need the hottest wheel, so the nominal runs come first.
  base::in_parallel(motors.size(), options.threads, 0, all, progress,
                    [&](std::size_t i) { evaluate_nominal(works[i], robot, duty, wheels, options); });
  base::in_parallel(jobs, options.threads, motors.size(), all, progress, [&](std::size_t job) {
    evaluate_samples(works[job / blocks], robot, duty, options, static_cast<int>(job % blocks) * base::kLanes);
  });
  std::vector<MotorEvaluation> results;
  for (Work& work : works) {
    conclude(work, options);
    results.push_back(std::move(work.result));
  }
  sort_by_verdict(results);
  return results;
}

}  // namespace heatsoak::select
