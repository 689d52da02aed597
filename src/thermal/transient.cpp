#include "thermal/transient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"

namespace heatsoak::thermal {
namespace {

/// The network as an initial value problem. With a ledger the heat of every effect is integrated by the same method as the temperatures, so
/// that the heat balance closes to rounding error and not only to the tolerance.
class NetworkSystem final : public ode::OdeSystem {
 public:
  NetworkSystem(const Network& network, std::span<const double> parameters, const TransientOptions& options)
      : network_(network),
        parameters_(parameters),
        limits_(options.limits),
        temperature_C_(static_cast<std::size_t>(network.node_count())),
        ledger_size_(options.with_ledger ? network.effects().size() * static_cast<std::size_t>(network.node_count()) : 0) {}

  void set(const OperatingPoint<double>& at) { at_ = at; }

  [[nodiscard]] int size() const override { return network_.state_count() + static_cast<int>(ledger_size_); }
  void derivative(double /*time_s*/, std::span<const double> y, std::span<double> dydt) override {
    const auto states = static_cast<std::size_t>(network_.state_count());
    std::copy_n(y.begin(), states, temperature_C_.begin());
    network_.rate_K_per_s<double>(at_, parameters_, temperature_C_, dydt.first(states));
    if (ledger_size_ > 0) {
      network_.balance_W(at_, parameters_, y.first(states), dydt.subspan(states));
    }
  }
  [[nodiscard]] int event_count() const override { return static_cast<int>(limits_.size()); }
  void events(double /*time_s*/, std::span<const double> y, std::span<double> values) override {
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      values[i] = y[static_cast<std::size_t>(limits_[i].node)] - limits_[i].limit_C;
    }
  }

 private:
  const Network& network_;
  std::span<const double> parameters_;
  std::span<const NodeLimit> limits_;
  OperatingPoint<double> at_;
  std::vector<double> temperature_C_;
  std::size_t ledger_size_;
};

/// About ten seconds of computing time; a match needs about a hundredth of these steps.
constexpr long kMostTransientSteps = 10'000'000;

/// Returns the maximum of the cubic Hermite interpolation and its position, 0 to 1. Slopes are per step.
std::pair<double, double> hermite_peak(double from, double to, double slope_from, double slope_to) {
  const double a = 2.0 * (from - to) + slope_from + slope_to;
  const double b = 3.0 * (to - from) - 2.0 * slope_from - slope_to;
  const double discriminant = b * b - 3.0 * a * slope_from;
  const double q = -(b + std::copysign(std::sqrt(std::max(0.0, discriminant)), b));
  std::pair<double, double> best = from > to ? std::pair(from, 0.0) : std::pair(to, 1.0);
  for (const double s : {q / (3.0 * a), slope_from / q}) {
    if (s > 0.0 && s < 1.0) {
      best = std::max(best, {from + s * (slope_from + s * (b + s * a)), s});
    }
  }
  return best;
}

class Run {
 public:
  Run(const Network& network, std::span<const double> parameters, const TransientOptions& options, const TransientObserver& observer)
      : states_(static_cast<std::size_t>(network.state_count())),
        options_(options),
        observer_(observer),
        system_(network, parameters, options),
        integrator_(system_, options.method, options.tolerances),
        y_(static_cast<std::size_t>(system_.size())),
        slope_(y_.size()),
        slope_before_(y_.size()) {}

  TransientResult over(std::span<const Interval> intervals) {
    begin(intervals);
    double start_s = 0.0;
    for (std::size_t i = 0; i < intervals.size() && !result_.destroyed; ++i) {
      const double stop_s = start_s + intervals[i].duration_s;
      through(i, intervals[i], start_s, stop_s);
      start_s = stop_s;
    }
    result_.end_C.assign(y_.begin(), y_.begin() + static_cast<std::ptrdiff_t>(states_));
    result_.heat_J.assign(y_.begin() + static_cast<std::ptrdiff_t>(states_), y_.end());
    result_.derivative_count = integrator_.derivative_count();
    return std::move(result_);
  }

 private:
  void begin(std::span<const Interval> intervals) {
    const double ambient_C = intervals.empty() ? 25.0 : intervals.front().at.ambient_C;
    std::fill_n(y_.begin(), states_, ambient_C);
    std::ranges::copy(options_.start_C, y_.begin());
    result_.peak_C.assign(y_.begin(), y_.begin() + static_cast<std::ptrdiff_t>(states_));
    result_.peak_time_s.assign(states_, 0.0);
    for (const NodeLimit& limit : options_.limits) {
      const bool over_at_start = y_[static_cast<std::size_t>(limit.node)] > limit.limit_C;
      result_.time_to_limit_s.push_back(over_at_start ? std::optional(0.0) : std::nullopt);
    }
  }

  void through(std::size_t index, const Interval& interval, double start_s, double stop_s) {
    system_.set(interval.at);
    integrator_.start(start_s, y_);
    system_.derivative(start_s, y_, slope_);
    observe(start_s, index, true);
    while (result_.end_s < stop_s && !result_.destroyed) {
      if (++steps_ > kMostTransientSteps) {
        throw base::Failure(base::ExitCode::numerics_failed,
                            fmt::format("{} steps took the run only to {:.6g} s; check whether a thermal resistance "
                                        "or a heat capacity is too small, or the duty too long",
                                        kMostTransientSteps, result_.end_s));
      }
      const ode::OdeStep step = integrator_.step(stop_s);
      note_crossings(step);
      advance_to(step.time_s);
      observe(step.time_s, index, false);
      if (step.at_event) {
        // After a very slow crossing the event function is still zero one rounding step later, and SUNDIALS fails ("root found at and very
        // near"). A restart accepts the zero.
        integrator_.start(step.time_s, y_);
      }
    }
  }

  void note_crossings(const ode::OdeStep& step) {
    for (std::size_t i = 0; step.at_event && i < step.crossed.size(); ++i) {
      if (step.crossed[i] > 0 && !result_.time_to_limit_s[i]) {
        result_.time_to_limit_s[i] = step.time_s;
      }
    }
  }

  void advance_to(double time_s) {
    const std::span<const double> state = integrator_.state();
    slope_before_.swap(slope_);
    system_.derivative(time_s, state, slope_);
    const double step_s = time_s - result_.end_s;
    for (std::size_t node = 0; node < states_; ++node) {
      const auto [value_C, share] = slope_before_[node] > 0.0 && slope_[node] < 0.0
                                        ? hermite_peak(y_[node], state[node], slope_before_[node] * step_s, slope_[node] * step_s)
                                        : std::pair(state[node], 1.0);
      if (value_C > result_.peak_C[node]) {
        result_.peak_C[node] = std::min(value_C, kDestroyed_C);
        result_.peak_time_s[node] = result_.end_s + share * step_s;
      }
      result_.destroyed = result_.destroyed || state[node] > kDestroyed_C;
    }
    note_passed_limits();
    std::ranges::copy(state, y_.begin());
    result_.end_s = time_s;
  }

  /// Adds crossings that root finding misses: a limit exceeded only within one step, or a start exactly at the limit.
  void note_passed_limits() {
    for (std::size_t i = 0; i < options_.limits.size(); ++i) {
      const auto& [node, limit_C] = options_.limits[i];
      const auto place = static_cast<std::size_t>(node);
      if (!result_.time_to_limit_s[i] && result_.peak_C[place] > limit_C) {
        result_.time_to_limit_s[i] = y_[place] < limit_C ? result_.peak_time_s[place] : result_.end_s;
      }
    }
  }

  void observe(double time_s, std::size_t interval, bool begins_interval) {
    if (observer_) {
      observer_({time_s, interval, begins_interval, std::span<const double>(y_).first(states_)});
    }
  }

  std::size_t states_;
  const TransientOptions& options_;
  const TransientObserver& observer_;
  NetworkSystem system_;
  ode::Integrator integrator_;
  std::vector<double> y_;
  std::vector<double> slope_;
  std::vector<double> slope_before_;
  TransientResult result_;
  long steps_ = 0;
};

}  // namespace

TransientResult run_transient(const Network& network, std::span<const double> parameters, std::span<const Interval> intervals,
                              const TransientOptions& options, const TransientObserver& observer) {
  return Run(network, parameters, options, observer).over(intervals);
}

}  // namespace heatsoak::thermal
