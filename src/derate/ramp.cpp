#include "derate/ramp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "base/diagnostic.h"
#include "derate/export_text.h"

namespace heatsoak::derate {
namespace {

/// Returns the breakpoints of an axis below `most`, and `most` itself.
std::vector<double> places_up_to(std::vector<double> axis, double most) {
  std::erase_if(axis, [&](double place) { return place >= most; });
  axis.push_back(most);
  return axis;
}

double hottest_C(const Derating& derating) { return std::floor(derating.rules.limits.winding_C); }

/// Returns the temperatures at which the ramp is compared with its bound, ascending.
/// Stator: the table's breakpoints suffice. Between two of them the bound is concave and the ramp is linear, so their smallest difference
/// is at a breakpoint. A point just above the axis has the bound 0.
/// Winding: the bound is not concave, because the resistance depends on the winding temperature. The points are 0.1 K apart.
std::vector<double> corners_C(const Derating& derating, RampSignal signal) {
  const bool is_stator = signal == RampSignal::stator;
  std::vector<double> corners = is_stator ? derating.table.stator_C : derating.table.winding_C;
  corners.push_back(std::floor(derating.options.hottest_ambient_C));
  if (is_stator) {
    corners.push_back(std::nextafter(derating.table.stator_C.back(), std::numeric_limits<double>::infinity()));
  } else {
    constexpr double kPerKelvin = 10.0;
    const int parts = static_cast<int>(kPerKelvin * (derating.table.winding_C.back() - derating.table.winding_C.front()));
    std::ranges::copy(evenly(derating.table.winding_C.front(), derating.table.winding_C.back(), std::max(2, parts)),
                      std::back_inserter(corners));
  }
  std::ranges::sort(corners);
  return corners;
}

struct BoundPoint {
  double signal_C = 0.0;
  double current_A = 0.0;
};

std::vector<BoundPoint> bound_points(const Derating& derating, RampSignal signal) {
  std::vector<BoundPoint> points;
  for (const double place_C : corners_C(derating, signal)) {
    points.push_back({place_C, ramp_bound_A(derating, signal, place_C)});
  }
  // Between two points of the winding's axis the bound is monotonic, so the smaller of both currents is a lower bound.
  for (std::size_t i = 0; signal == RampSignal::winding && i + 1 < points.size(); ++i) {
    points[i].current_A = std::min(points[i].current_A, points[i + 1].current_A);
  }
  return points;
}

/// Returns the largest full current in A of a ramp from `start_C` to `end_C` that stays below the bound.
double most_current_A(const std::vector<BoundPoint>& points, double full_until_C, double bound_there_A, double start_C, double end_C) {
  double most_A = bound_there_A;
  for (const BoundPoint& point : points) {
    if (point.signal_C <= full_until_C) {
      most_A = std::min(most_A, point.current_A);
    } else if (point.signal_C < end_C) {
      most_A = std::min(most_A, point.current_A * (end_C - start_C) / (end_C - point.signal_C));
    }
  }
  return most_A;
}

/// Returns the mean current of a ramp over an interval that contains its start.
double mean_A(const CurrentRamp& ramp, double from_C, double to_C) {
  return ramp.most_current_A * (ramp.start_C - from_C + 0.5 * (ramp.end_C - ramp.start_C)) / (to_C - from_C);
}

/// Returns the nodes other than winding and stator on which the rates of the first `states` nodes depend.
std::set<std::string> hidden_nodes(const Observer& observer, std::size_t states) {
  const std::vector<char> needed = observer.formula().needed_for(observer.rate_steps().first(states));
  std::set<std::string> nodes;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = observer.formula().steps()[i];
    const std::size_t first_hidden = observed::kSignalCount + static_cast<std::size_t>(motor::states::first_own);
    if (needed[i] != 0 && step.operation == thermal::Operation::input && static_cast<std::size_t>(step.left) >= first_hidden) {
      nodes.insert(observer.state_names()[static_cast<std::size_t>(step.left) - observed::kSignalCount]);
    }
  }
  return nodes;
}

void require_stator_is_enough(std::string_view controller, const Derating& derating) {
  const std::set<std::string> hidden = hidden_nodes(derating.observer, derating.rules.limits.stator_C ? 2 : 1);
  if (!hidden.empty()) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{} cannot express {} ({}): it affects a temperature that has a limit, but the controller measures the stator only; "
                    "use --to c_header",
                    controller, fmt::join(hidden, ", "), own_effects_text(derating)));
  }
}

}  // namespace

double CurrentRamp::current_A(double signal_C) const {
  if (signal_C <= start_C + full_beyond_K) {
    return most_current_A;
  }
  return signal_C < end_C ? most_current_A * (end_C - signal_C) / (end_C - start_C) : 0.0;
}

double ramp_bound_A(const Derating& derating, RampSignal signal, double signal_C) {
  const CurrentTable& table = derating.table;
  const bool is_stator = signal == RampSignal::stator;
  if (is_stator && signal_C > table.stator_C.back()) {
    return 0.0;
  }
  const std::vector<double> unseen_C = places_up_to(is_stator ? table.winding_C : table.stator_C, derating.rules.limits.winding_C);
  double least_A = derating.rules.most_current_A;
  for (const double speed_rad_per_s : places_up_to(table.speed_rad_per_s, derating.rules.most_speed_rad_per_s)) {
    for (const double each_C : unseen_C) {
      least_A = std::min(least_A, table.allowed_A(speed_rad_per_s, is_stator ? signal_C : each_C, is_stator ? each_C : signal_C));
    }
  }
  return least_A;
}

CurrentRamp fit_ramp(const Derating& derating, RampSignal signal, double full_beyond_K) {
  const std::vector<BoundPoint> points = bound_points(derating, signal);
  const double from_C = std::floor(derating.options.hottest_ambient_C);
  const double to_C = hottest_C(derating);
  CurrentRamp best{.start_C = from_C, .end_C = to_C, .most_current_A = 0.0, .full_beyond_K = full_beyond_K};
  double best_mean_A = 0.0;
  for (double start_C = from_C; start_C < to_C; start_C += 1.0) {
    const double bound_there_A = ramp_bound_A(derating, signal, start_C + full_beyond_K);
    for (double end_C = start_C + 1.0; end_C <= to_C; end_C += 1.0) {
      const CurrentRamp ramp{.start_C = start_C,
                             .end_C = end_C,
                             .most_current_A = most_current_A(points, start_C + full_beyond_K, bound_there_A, start_C, end_C),
                             .full_beyond_K = full_beyond_K};
      if (const double ramp_mean_A = mean_A(ramp, from_C, to_C); ramp_mean_A > best_mean_A) {
        best_mean_A = ramp_mean_A;
        best = ramp;
      }
    }
  }
  return best;
}

RampLoss ramp_loss(const Derating& derating, RampSignal signal, const CurrentRamp& ramp) {
  RampLoss loss{.from_C = std::floor(derating.options.hottest_ambient_C), .to_C = hottest_C(derating)};
  const int steps = std::max(1, static_cast<int>(loss.to_C - loss.from_C));
  for (int i = 0; i < steps; ++i) {
    const double signal_C = loss.from_C + i + 0.5;
    const double bound_A = ramp_bound_A(derating, signal, signal_C);
    const double ramp_A = ramp.current_A(signal_C);
    loss.bound_mean_A += bound_A / steps;
    loss.ramp_mean_A += ramp_A / steps;
    if (bound_A - ramp_A > loss.most_A) {
      loss.most_A = bound_A - ramp_A;
      loss.most_at_C = signal_C;
    }
  }
  loss.peak_A = derating.table.allowed_A(0.0, derating.options.hottest_ambient_C, derating.options.hottest_ambient_C);
  return loss;
}

CurrentRamp ramp_for(std::string_view controller, const Derating& derating, RampSignal signal, double full_beyond_K) {
  require_finite(derating);
  if (derating.rules.most_speed_rad_per_s < derating.reachable_speed_rad_per_s) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{} cannot express that above {:.0f} rad/s this motor exceeds its limit without current, because its ramp "
                    "depends on a temperature only; use --to c_header",
                    controller, derating.rules.most_speed_rad_per_s));
  }
  if (signal == RampSignal::stator) {
    require_stator_is_enough(controller, derating);
  } else if (derating.rules.limits.stator_C) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{} cannot express the stator limit of {:.0f} °C: its ramp depends on the winding's temperature only; use --to "
                    "c_header",
                    controller, *derating.rules.limits.stator_C));
  }
  const CurrentRamp ramp = fit_ramp(derating, signal, full_beyond_K);
  if (!(ramp.most_current_A > 0.0)) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{}: the table allows no current for a ramp in air of {:.0f} °C at all speeds up to {:.0f} rad/s; use a lower "
                    "--ambient or --to c_header",
                    controller, derating.options.hottest_ambient_C, derating.rules.most_speed_rad_per_s));
  }
  return ramp;
}

}  // namespace heatsoak::derate
