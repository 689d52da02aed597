#include "derate/guarantee.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "select/spread.h"
#include "thermal/ensemble.h"

namespace heatsoak {
namespace {

constexpr double kSettled = 4.0;  ///< slowest time constants
constexpr double kShortest_s = 900.0;
constexpr double kLongest_s = 4.0 * 3600.0;

struct SamplePeak {
  double winding_C = 0.0;
  bool is_over = false;
};

/// Eight drawn motors through every use.
std::array<SamplePeak, kLanes> peaks(const Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses,
                                     std::uint64_t seed, std::uint64_t first_stream) {
  std::vector<Network> networks;
  std::vector<Lanes> parameters;
  for (int lane = 0; lane < kLanes; ++lane) {
    Random random(seed, first_stream + static_cast<std::uint64_t>(lane));
    networks.push_back(datasheet_network(motor, draw_sample(motor, random)));
    const std::vector<double> values = networks.back().values();
    parameters.resize(values.size());
    for (std::size_t p = 0; p < values.size(); ++p) {
      parameters[p][lane] = values[p];
    }
  }
  std::array<SamplePeak, kLanes> result;
  for (const UsePlayed& each : uses) {
    const auto to_lanes = [](const OperatingPoint<double>& at) {
      OperatingPoint<Lanes> lanes;
      for_each_quantity([](Lanes& to, const double& from) { to = Lanes::Constant(from); }, lanes, at);
      return lanes;
    };
    const double ambient_C = each.intervals.front().at.ambient_C;
    const std::vector<Lanes> start_C(static_cast<std::size_t>(networks.front().state_count()), Lanes::Constant(ambient_C));
    EnsembleRun run(networks.front(), parameters, start_C);
    const double step_s = longest_step_s(networks.front(), parameters, to_lanes(each.intervals.front().at), limits.winding_C - ambient_C);
    for (const Interval& interval : each.intervals) {
      run.over(interval.duration_s, to_lanes(interval.at), step_s);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      SamplePeak& peak = result[static_cast<std::size_t>(lane)];
      const double winding_C = run.peak_C()[states::winding][lane];
      peak.winding_C = std::max(peak.winding_C, winding_C);
      peak.is_over =
          peak.is_over || winding_C > limits.winding_C || (limits.stator_C && run.peak_C()[states::stator][lane] > *limits.stator_C);
    }
  }
  return result;
}

}  // namespace

void PlayedIntervals::take(double time_s, double current_A, double speed_rad_per_s, double period_s) {
  constexpr double kLongest_s = 1.0;
  constexpr double kLittle = 0.02;
  if (duration_s_ > 0.0 &&
      (duration_s_ >= kLongest_s || std::abs(current_A - first_A_) > kLittle * first_A_ || speed_rad_per_s != speed_rad_per_s_)) {
    end(time_s);
  }
  speed_rad_per_s_ = speed_rad_per_s;
  first_A_ = duration_s_ > 0.0 ? first_A_ : current_A;
  duration_s_ += period_s;
  heat_A2_s_ += current_A * current_A * period_s;
}

void PlayedIntervals::end(double time_s) {
  const double current_rms_A = std::sqrt(heat_A2_s_ / duration_s_);
  const Signals signals = played_.use.hot_case.signals(rules_, current_rms_A, speed_rad_per_s_);
  played_.intervals.push_back({duration_s_, operating_point<double>(motor_.nominal, robot_, signals)});
  played_.time_s.push_back(time_s);
  played_.current_A.push_back(current_rms_A);
  duration_s_ = heat_A2_s_ = 0.0;
}

double use_duration_s(const MotorValues& motor) {
  return std::clamp(kSettled * motor.thermal_time_constant_stator_s, kShortest_s, kLongest_s);
}

std::vector<Use> hardest_uses(const Observer& observer, const BarrierRules& rules) {
  static constexpr std::array<Use, 11> kPlain{{{0.0},
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
  static constexpr std::array<Use, 8> kOther{{{0.0},
                                              {0.3},
                                              {0.98},
                                              {0.6, 2.0, 4.0, 0.6},
                                              {0.6, 30.0, 30.0, 0.6},
                                              {0.0, 30.0, 90.0, 0.98},
                                              {0.0, 60.0, 240.0, 0.0},
                                              {0.0, 60.0, 240.0, 0.98}}};
  const std::vector<HotCase> cases = hot_cases(observer, rules);
  std::vector<Use> uses;
  const auto add = [&uses](std::span<const Use> patterns, const HotCase& hot_case) {
    for (Use use : patterns) {
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

UsePlayed play(const Observer& observer, const CurrentTable& table, const BarrierRules& rules, const Motor& motor, const Robot& robot,
               const Use& use, double period_s) {
  UsePlayed result;
  result.use = use;
  ObserverRun<float> run(observer, static_cast<float>(period_s), static_cast<float>(rules.hottest_ambient_C));
  const auto periods = static_cast<std::int64_t>(use_duration_s(motor.nominal) / period_s);
  PlayedIntervals intervals(result, motor, robot, rules);
  for (std::int64_t i = 0; i < periods; ++i) {
    const double time_s = static_cast<double>(i) * period_s;
    const bool is_on = use.on_s <= 0.0 || std::fmod(time_s, use.on_s + use.off_s) < use.on_s;
    const double speed_rad_per_s = (is_on ? use.speed_share : use.off_speed_share) * rules.most_speed_rad_per_s;
    const float allowed_A =
        is_on ? table.allowed_A(static_cast<float>(speed_rad_per_s), run.hottest_body_C(), run.state_C()[states::winding]) : 0.0F;
    intervals.take(time_s, allowed_A, speed_rad_per_s, period_s);
    std::array<float, firmware::kSignalCount> told{};
    std::ranges::transform(use.hot_case.signals(rules, allowed_A, speed_rad_per_s), told.begin(),
                           [](double value) { return static_cast<float>(value); });
    run.step(told);
    result.winding_peak_C = std::max<double>(result.winding_peak_C, run.state_C()[states::winding]);
    result.stator_peak_C = std::max<double>(result.stator_peak_C, run.state_C()[states::stator]);
  }
  intervals.end(static_cast<double>(periods) * period_s);
  return result;
}

Guarantee check(const Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses, const GuaranteeOptions& options,
                std::uint64_t first_stream, const Progress& progress) {
  const auto blocks = static_cast<std::size_t>((options.samples + kLanes - 1) / kLanes);
  std::vector<SamplePeak> all(blocks * kLanes);
  in_parallel(blocks, options.threads, 0, blocks, progress, [&](std::size_t block) {
    const auto found = peaks(motor, limits, uses, options.seed, first_stream + block * kLanes);
    std::ranges::copy(found, all.begin() + static_cast<std::ptrdiff_t>(block * kLanes));
  });
  all.resize(static_cast<std::size_t>(options.samples));
  std::vector<double> winding_C;
  std::vector<char> is_over;
  for (const SamplePeak& each : all) {
    winding_C.push_back(each.winding_C);
    is_over.push_back(each.is_over ? 1 : 0);
  }
  Guarantee result{.samples = options.samples,
                   .over = static_cast<int>(std::ranges::count(is_over, char{1})),
                   .over_share = sample_intervals(winding_C, is_over).probability};
  std::ranges::sort(winding_C);
  result.winding_p50_C = quantile(winding_C, 0.5);
  result.winding_p95_C = quantile(winding_C, 0.95);
  result.winding_most_C = winding_C.back();
  return result;
}

}  // namespace heatsoak
