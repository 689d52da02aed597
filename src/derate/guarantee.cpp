#include "derate/guarantee.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "base/binomial_bound.h"
#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "select/spread.h"
#include "thermal/ensemble.h"

namespace heatsoak::derate {
namespace {

constexpr double kSettled = 4.0;  ///< slowest time constants
constexpr double kShortest_s = 900.0;
constexpr double kLongest_s = 4.0 * 3600.0;

}  // namespace

std::vector<thermal::Network> drawn_networks(const motor::Motor& motor, std::uint64_t seed, std::uint64_t first_stream) {
  std::vector<thermal::Network> networks;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    base::Random random(seed, first_stream + static_cast<std::uint64_t>(lane));
    networks.push_back(motor::datasheet_network(motor, motor::draw_sample(motor, random)));
  }
  return networks;
}

std::array<MotorPeak, base::kLanes> peaks(std::span<const thermal::Network> motors, const TemperatureLimits& limits,
                                          std::span<const UsePlayed> uses) {
  std::vector<thermal::Lanes> parameters;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    const std::vector<double> values = motors[static_cast<std::size_t>(lane)].values();
    parameters.resize(values.size());
    for (std::size_t p = 0; p < values.size(); ++p) {
      parameters[p][lane] = values[p];
    }
  }
  const thermal::Network& network = motors.front();
  std::array<MotorPeak, base::kLanes> result;
  for (const UsePlayed& each : uses) {
    thermal::OperatingPoint<thermal::Lanes> at;
    const auto put_in_lanes = [&at](const thermal::OperatingPoint<double>& one) {
      thermal::convert_point([](thermal::Lanes& to, const double& from) { to = thermal::Lanes::Constant(from); }, at, one);
    };
    const double ambient_C = each.intervals.front().at.ambient_C;
    const std::vector<thermal::Lanes> start_C(static_cast<std::size_t>(network.state_count()),
                                              thermal::Lanes::Constant(each.start_C.value_or(ambient_C)));
    thermal::EnsembleRun run(network, parameters, start_C);
    put_in_lanes(each.intervals.front().at);
    const double step_s = thermal::longest_step_s(network, parameters, at, limits.winding_C - ambient_C);
    for (const thermal::Interval& interval : each.intervals) {
      put_in_lanes(interval.at);
      run.over(interval.duration_s, at, step_s);
    }
    for (int lane = 0; lane < base::kLanes; ++lane) {
      MotorPeak& peak = result[static_cast<std::size_t>(lane)];
      const auto take = [&](double peak_C, double limit_C) {
        peak.limit_use_ratio = std::max(peak.limit_use_ratio, (peak_C - ambient_C) / (limit_C - ambient_C));
        peak.is_over = peak.is_over || peak_C > limit_C;
      };
      const double winding_C = run.peak_C()[motor::states::winding][lane];
      peak.winding_C = std::max(peak.winding_C, winding_C);
      take(winding_C, limits.winding_C);
      if (limits.stator_C) {
        take(run.peak_C()[motor::states::stator][lane], *limits.stator_C);
      }
    }
  }
  return result;
}

void PlayedIntervals::take(double time_s, double current_A, double speed_rad_per_s, double period_s) {
  if (held_.is_over(current_A, speed_rad_per_s)) {
    end(time_s);
  }
  held_.take(current_A, speed_rad_per_s, period_s);
}

void PlayedIntervals::end(double time_s) {
  const double current_rms_A = held_.rms_A();
  const Signals signals = played_.use.hot_case.signals(rules_, current_rms_A, held_.speed_rad_per_s);
  played_.intervals.push_back({held_.duration_s, operating_point<double>(motor_.nominal, robot_, signals)});
  played_.time_s.push_back(time_s);
  played_.current_A.push_back(current_rms_A);
  held_ = {};
}

double use_duration_s(const motor::MotorValues& motor) {
  return std::clamp(kSettled * motor.thermal_time_constant_stator_s, kShortest_s, kLongest_s);
}

std::vector<LoadPattern> hardest_patterns(const Observer& observer, const BarrierRules& rules) {
  static constexpr std::array<LoadPattern, 11> kPlain{{{0.0},
                                                       {0.3},
                                                       {0.6},
                                                       {0.98},
                                                       {0.0, 2.0, 4.0, 0.0},
                                                       {0.6, 2.0, 4.0, 0.6},
                                                       {0.6, 30.0, 30.0, 0.6},
                                                       {0.0, 30.0, 90.0, 0.98},
                                                       {0.0, 60.0, 240.0, 0.98},
                                                       {0.0, 60.0, 120.0, 0.0},
                                                       {0.6, 60.0, 120.0, 0.6}}};
  static constexpr std::array<LoadPattern, 8> kOther{{{0.0},
                                                      {0.3},
                                                      {0.98},
                                                      {0.6, 2.0, 4.0, 0.6},
                                                      {0.6, 30.0, 30.0, 0.6},
                                                      {0.0, 30.0, 90.0, 0.98},
                                                      {0.0, 60.0, 240.0, 0.0},
                                                      {0.0, 60.0, 240.0, 0.98}}};
  const std::vector<HotCase> cases = hot_cases(observer, rules);
  std::vector<LoadPattern> uses;
  const auto add = [&uses](std::span<const LoadPattern> patterns, const HotCase& hot_case) {
    for (LoadPattern use : patterns) {
      use.hot_case = hot_case;
      uses.push_back(use);
    }
  };
  add(kPlain, cases.front());
  for (std::size_t i = 1; i < cases.size(); ++i) {
    add(kOther, cases[i]);
  }
  return uses;
}

std::vector<UsePlayed> play(const Observer& observer, const CurrentTable& table, const BarrierRules& rules, const motor::Motor& motor,
                            const robot::Robot& robot, std::span<const LoadPattern> uses, double period_s) {
  std::vector<UsePlayed> result(uses.size());
  std::vector<PlayedIntervals> intervals;
  std::array<thermal::SingleLanes, observed::kSignalCount> signals;
  signals.fill(thermal::SingleLanes::Zero());
  for (std::size_t lane = 0; lane < uses.size(); ++lane) {
    result[lane].use = uses[lane];
    intervals.emplace_back(result[lane], motor, robot, rules);
  }
  ObserverRun<thermal::SingleLanes> run(observer, thermal::SingleLanes::Constant(static_cast<float>(period_s)),
                                        thermal::SingleLanes::Constant(static_cast<float>(rules.hottest_ambient_C)));
  thermal::SingleLanes winding_peak_C = thermal::SingleLanes::Zero();
  thermal::SingleLanes stator_peak_C = thermal::SingleLanes::Zero();
  const auto periods = static_cast<std::int64_t>(use_duration_s(motor.nominal) / period_s);
  for (std::int64_t i = 0; i < periods; ++i) {
    const double time_s = static_cast<double>(i) * period_s;
    const thermal::SingleLanes body_C = run.hottest_body_C();
    const thermal::SingleLanes winding_C = run.state_C()[motor::states::winding];
    for (std::size_t lane = 0; lane < uses.size(); ++lane) {
      const LoadPattern& use = uses[lane];
      const auto place = static_cast<Eigen::Index>(lane);
      const bool is_on = use.on_s <= 0.0 || std::fmod(time_s, use.on_s + use.off_s) < use.on_s;
      const double speed_rad_per_s = (is_on ? use.speed_share : use.off_speed_share) * rules.most_speed_rad_per_s;
      const float allowed_A = is_on ? table.allowed_A(static_cast<float>(speed_rad_per_s), body_C[place], winding_C[place]) : 0.0F;
      intervals[lane].take(time_s, allowed_A, speed_rad_per_s, period_s);
      const Signals all = use.hot_case.signals(rules, allowed_A, speed_rad_per_s);
      for (std::size_t signal = 0; signal < all.size(); ++signal) {
        signals[signal][place] = static_cast<float>(all[signal]);
      }
    }
    run.step(signals);
    winding_peak_C = winding_peak_C.max(run.state_C()[motor::states::winding]);
    stator_peak_C = stator_peak_C.max(run.state_C()[motor::states::stator]);
  }
  for (std::size_t lane = 0; lane < uses.size(); ++lane) {
    intervals[lane].end(static_cast<double>(periods) * period_s);
    result[lane].winding_peak_C = winding_peak_C[static_cast<Eigen::Index>(lane)];
    result[lane].stator_peak_C = stator_peak_C[static_cast<Eigen::Index>(lane)];
  }
  return result;
}

Guarantee check(const motor::Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses,
                const GuaranteeOptions& options, std::uint64_t first_stream, const base::Progress& progress) {
  const auto blocks = static_cast<std::size_t>((options.samples + base::kLanes - 1) / base::kLanes);
  std::vector<MotorPeak> all(blocks * base::kLanes);
  base::in_parallel(blocks, options.threads, 0, blocks, progress, [&](std::size_t block) {
    const auto found = peaks(drawn_networks(motor, options.seed, first_stream + block * base::kLanes), limits, uses);
    std::ranges::copy(found, all.begin() + static_cast<std::ptrdiff_t>(block * base::kLanes));
  });
  all.resize(static_cast<std::size_t>(options.samples));
  return guarantee(all);
}

std::optional<int> most_over(const GuaranteeOptions& goal) {
  std::optional<int> most;
  for (int over = 0; over <= goal.samples && 1.0 - base::upper_bound_share(over, goal.samples, kCertainty_share) >= goal.required_share;
       ++over) {
    most = over;
  }
  return most;
}

Guarantee guarantee(std::span<const MotorPeak> peaks) {
  std::vector<double> winding_C;
  std::ranges::transform(peaks, std::back_inserter(winding_C), &MotorPeak::winding_C);
  Guarantee result{.samples = static_cast<int>(peaks.size()),
                   .over = static_cast<int>(std::ranges::count_if(peaks, [](const MotorPeak& each) { return each.is_over; }))};
  std::ranges::sort(winding_C);
  result.winding_p50_C = select::quantile(winding_C, 0.5);
  result.winding_p95_C = select::quantile(winding_C, 0.95);
  result.winding_most_C = winding_C.back();
  return result;
}

}  // namespace heatsoak::derate
