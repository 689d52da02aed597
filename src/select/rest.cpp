#include "select/rest.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "base/diagnostic.h"
#include "motor/datasheet_network.h"
#include "select/drive_profile.h"
#include "thermal/ensemble.h"
#include "thermal/steady_state.h"

namespace heatsoak::select {
namespace {

using motor::states::stator;
using motor::states::winding;

using State = std::vector<double>;  ///< temperature of every state node in °C
using Rests = std::array<int, base::kLanes>;

thermal::OperatingPoint<thermal::Lanes> in_all_lanes(const thermal::OperatingPoint<double>& one) {
  thermal::OperatingPoint<thermal::Lanes> at;
  thermal::convert_point([](thermal::Lanes& to, const double& from) { to = thermal::Lanes::Constant(from); }, at, one);
  return at;
}

/// One motor that is hot, rests and plays; each lane has another rest.
class HotMotor {
 public:
  HotMotor(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& demand, const motor::Motor& motor)
      : sample_(motor::nominal_sample(motor)), network_(motor::datasheet_network(motor, sample_)), demanded_(nominal_sample(duty)) {
    for (const double value : network_.values()) {
      parameters_.emplace_back(thermal::Lanes::Constant(value));
    }
    rest_ = operating_point(sample_.values, robot, duty.kind, duty::constant_bin(1.0, 0.0, 0.0, 0.0), demanded_);
    step_s_ = longest_step_s(rest_);
    const thermal::Interval* strongest = nullptr;
    play_ = intervals(sample_.values, robot, duty.kind, demand, demanded_);
    for (const thermal::Interval& each : play_) {
      strongest = strongest == nullptr || each.at.current_rms_A > strongest->at.current_rms_A ? &each : strongest;
      duration_s_ += each.duration_s;
    }
    const auto fastest = std::ranges::max_element(play_, {}, [](const auto& each) { return each.at.speed_rms_rad_per_s; });
    step_s_ = std::min({step_s_, longest_step_s(strongest->at), longest_step_s(fastest->at)});
  }

  /// Returns whether the motor that stands still without current is not below its limits in steady state.
  [[nodiscard]] bool is_over_without_current() const { return excess_K(0.0) >= 0.0; }

  /// Cools the motor, which must be below its limits without current, from its hottest steady state. Returns false if no current brings it
  /// to a limit.
  bool rests() {
    const std::optional<State> hot_C = at_its_limit();
    if (!hot_C) {
      return false;
    }
    thermal::EnsembleRun run(network_, parameters_, lanes_of(*hot_C));
    const thermal::OperatingPoint<thermal::Lanes> at = in_all_lanes(rest_);
    for (int second = 0; second <= kLongestRest_s; ++second) {
      State now_C;
      std::ranges::transform(run.state_C(), std::back_inserter(now_C), [](const thermal::Lanes& each) { return each[0]; });
      rested_C_.push_back(std::move(now_C));
      run.over(1.0, at, step_s_);
    }
    return true;
  }

  [[nodiscard]] std::vector<double> starts_s() const {
    constexpr double kLeastApart_s = 60.0;
    constexpr double kMost = 16.0;
    const double apart_s = std::max(kLeastApart_s, duration_s_ / kMost);
    std::vector<double> all;
    for (double at_s = 0.0; at_s < std::max(duration_s_ - 0.5 * apart_s, 1e-9); at_s += apart_s) {
      all.push_back(at_s);
    }
    return all;
  }

  /// Returns the shortest sufficient rest in whole seconds; empty if there is none. A longer rest leaves the motor colder,
  /// so it is sufficient too.
  [[nodiscard]] std::optional<int> rest_s(double start_s, double play_s) const {
    Rests rests{0, 30, 60, 120, 300, 600, 1200, kLongestRest_s};
    int short_s = -1;
    for (;;) {
      const std::array<bool, base::kLanes> keeps = keeps_limits(rests, start_s, play_s);
      const auto first = static_cast<std::size_t>(std::ranges::find(keeps, true) - keeps.begin());
      if (first == keeps.size()) {
        return std::nullopt;
      }
      short_s = first > 0 ? rests.at(first - 1) : short_s;
      const int enough_s = rests.at(first);
      if (enough_s - short_s <= 1) {
        return enough_s;
      }
      for (int lane = 0; lane < base::kLanes; ++lane) {
        rests.at(static_cast<std::size_t>(lane)) = short_s + std::max(1, (enough_s - short_s) * (lane + 1) / base::kLanes);
      }
    }
  }

 private:
  [[nodiscard]] double longest_step_s(const thermal::OperatingPoint<double>& at) const {
    constexpr double kHotter_K = 60.0;
    const thermal::OperatingPoint<thermal::Lanes> lanes = in_all_lanes(at);
    return std::min(thermal::longest_step_s(network_, parameters_, lanes),
                    thermal::longest_step_s(network_, parameters_, lanes, kHotter_K));
  }

  /// Returns by how much the first node is over its limit; infinite at thermal runaway.
  [[nodiscard]] double excess_K(double current_A) const {
    thermal::OperatingPoint<double> at = rest_;
    at.current_rms_A = current_A;
    std::optional<thermal::SteadyState> steady;
    try {
      steady = thermal::steady_state(network_, at);
    } catch (const base::Failure& failure) {
      if (failure.code() != base::ExitCode::numerics_failed) {
        throw;  // without convergence the current is near thermal runaway, which is above every limit
      }
    }
    if (!steady) {
      return std::numeric_limits<double>::infinity();
    }
    const double winding_K = steady->temperature_C[winding] - sample_.values.winding_limit_C;
    return sample_.values.stator_limit_C ? std::max(winding_K, steady->temperature_C[stator] - *sample_.values.stator_limit_C) : winding_K;
  }

  [[nodiscard]] std::optional<State> at_its_limit() const {
    constexpr double kMost_A = 1e4;
    constexpr int kBits = 40;
    double high_A = 0.01;
    constexpr double kStep = 1.2;  // small, so that the first current above a limit is far from thermal runaway
    while (excess_K(high_A) <= 0.0) {
      high_A *= kStep;
      if (high_A > kMost_A) {
        return std::nullopt;
      }
    }
    const auto excess = [this](double current_A) { return excess_K(current_A); };
    thermal::OperatingPoint<double> at = rest_;
    at.current_rms_A = boost::math::tools::bisect(excess, 0.0, high_A, boost::math::tools::eps_tolerance<double>(kBits)).first;
    return thermal::steady_state(network_, at)->temperature_C;
  }

  static std::vector<thermal::Lanes> lanes_of(const State& state_C) {
    std::vector<thermal::Lanes> lanes;
    std::ranges::transform(state_C, std::back_inserter(lanes), [](double each) { return thermal::Lanes::Constant(each); });
    return lanes;
  }

  /// Returns for each rest whether the motor keeps its limits during the play.
  [[nodiscard]] std::array<bool, base::kLanes> keeps_limits(const Rests& rests, double start_s, double play_s) const {
    std::vector<thermal::Lanes> from_C(rested_C_.front().size());
    for (std::size_t lane = 0; lane < rests.size(); ++lane) {
      for (std::size_t node = 0; node < from_C.size(); ++node) {
        from_C[node][static_cast<int>(lane)] = rested_C_[static_cast<std::size_t>(rests.at(lane))][node];
      }
    }
    thermal::EnsembleRun run(network_, parameters_, from_C);
    double before_s = start_s;  // time of the duty before the play begins
    double left_s = play_s;
    for (std::size_t i = 0; left_s > 0.0; i = (i + 1) % play_.size()) {
      const double skipped_s = std::min(before_s, play_[i].duration_s);
      before_s -= skipped_s;
      const double part_s = std::min(play_[i].duration_s - skipped_s, left_s);
      if (part_s > 0.0) {
        run.over(part_s, in_all_lanes(play_[i].at), step_s_);
        left_s -= part_s;
      }
    }
    // Without rest the motor starts exactly at its limit; a rounding error must not count as exceeding it.
    constexpr double kTolerance_K = 1e-3;
    std::array<bool, base::kLanes> keeps{};
    for (int lane = 0; lane < base::kLanes; ++lane) {
      const bool is_winding_over = run.peak_C()[winding][lane] > sample_.values.winding_limit_C + kTolerance_K;
      const bool is_stator_over =
          sample_.values.stator_limit_C && run.peak_C()[stator][lane] > *sample_.values.stator_limit_C + kTolerance_K;
      keeps.at(static_cast<std::size_t>(lane)) = !is_winding_over && !is_stator_over;
    }
    return keeps;
  }

  motor::MotorSample sample_;
  thermal::Network network_;
  DutySample demanded_;
  std::vector<thermal::Lanes> parameters_;
  thermal::OperatingPoint<double> rest_;
  std::vector<thermal::Interval> play_;
  double duration_s_ = 0.0;
  double step_s_ = 0.0;
  std::vector<State> rested_C_;  ///< after each second of rest
};

}  // namespace

namespace {

/// Returns the rests of a motor for which none suffices.
std::vector<RestOfHotMotor> rests_without_effect(int starts) {
  std::vector<RestOfHotMotor> all;
  for (const double play_s : kPlays_s) {
    all.push_back({.play_s = play_s, .half_s = {}, .all_s = {}, .starts = starts, .starts_never = starts, .over_without_current = true});
  }
  return all;
}

}  // namespace

std::vector<RestOfHotMotor> rests_of_hot_motor(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& demand,
                                               const motor::Motor& motor) {
  HotMotor hot(robot, duty, demand, motor);
  const std::vector<double> starts_s = hot.starts_s();
  if (hot.is_over_without_current()) {
    return rests_without_effect(static_cast<int>(starts_s.size()));
  }
  std::vector<RestOfHotMotor> all;
  if (!hot.rests()) {
    return all;
  }
  for (const double play_s : kPlays_s) {
    std::vector<int> rests;
    for (const double start_s : starts_s) {
      if (const std::optional<int> rest_s = hot.rest_s(start_s, play_s)) {
        rests.push_back(*rest_s);
      }
    }
    std::ranges::sort(rests);
    RestOfHotMotor& result = all.emplace_back();
    result.play_s = play_s;
    result.starts = static_cast<int>(starts_s.size());
    result.starts_never = static_cast<int>(starts_s.size() - rests.size());
    const std::size_t half = starts_s.size() / 2;
    result.half_s = half < rests.size() ? std::optional<double>(rests[half]) : std::nullopt;
    result.all_s = result.starts_never == 0 ? std::optional<double>(rests.back()) : std::nullopt;
  }
  return all;
}

}  // namespace heatsoak::select
