#include "derate/own_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::derate {
namespace {

/// Lasting current of one hot case, speeds ascending.
struct LastingPoint {
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;
};

/// Returns the lasting currents of the continuous uses, one list per hot case.
std::vector<std::vector<LastingPoint>> lasting_by_case(const Derating& derating) {
  std::vector<std::pair<HotCase, std::vector<LastingPoint>>> cases;
  for (const UsePlayed& each : derating.uses) {
    if (each.use.on_s > 0.0 || each.current_A.empty()) {
      continue;
    }
    auto found = std::ranges::find_if(cases, [&](const auto& known) { return known.first == each.use.hot_case; });
    if (found == cases.end()) {
      found = cases.insert(cases.end(), {each.use.hot_case, {}});
    }
    found->second.push_back({each.use.speed_share * derating.rules.most_speed_rad_per_s, each.current_A.back()});
  }
  std::vector<std::vector<LastingPoint>> all;
  for (auto& [hot_case, points] : cases) {
    std::ranges::sort(points, {}, &LastingPoint::speed_rad_per_s);
    all.push_back(std::move(points));
  }
  return all;
}

double square(double x) { return x * x; }

double lasting_at_A(const std::vector<LastingPoint>& points, double speed_rad_per_s) {
  const auto next = std::ranges::lower_bound(points, speed_rad_per_s, {}, &LastingPoint::speed_rad_per_s);
  if (next == points.begin() || next == points.end()) {
    return next == points.end() ? points.back().current_A : next->current_A;
  }
  const LastingPoint& last = *(next - 1);
  const double share = (speed_rad_per_s - last.speed_rad_per_s) / (next->speed_rad_per_s - last.speed_rad_per_s);
  return std::sqrt(std::lerp(square(last.current_A), square(next->current_A), share));
}

/// Returns the speed at which the lasting current falls below `needed_A`; the last speed if it does not.
double held_speed_rad_per_s(const std::vector<LastingPoint>& points, double needed_A) {
  double held_rad_per_s = 0.0;
  for (std::size_t i = 0; i < points.size() && points[i].current_A >= needed_A; ++i) {
    held_rad_per_s = points[i].speed_rad_per_s;
    if (i + 1 < points.size() && points[i + 1].current_A < needed_A) {
      const double fall_A2 = square(points[i].current_A) - square(points[i + 1].current_A);
      held_rad_per_s += (points[i + 1].speed_rad_per_s - held_rad_per_s) * (square(points[i].current_A) - square(needed_A)) / fall_A2;
    }
  }
  return held_rad_per_s;
}

}  // namespace

std::optional<OwnFriction> own_friction(const Derating& derating) {
  const std::vector<std::vector<LastingPoint>> cases = lasting_by_case(derating);
  if (cases.empty()) {
    return std::nullopt;
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  OwnFriction found{.needed_A = derating.nominal.no_load_current_A,
                    .speed_rad_per_s = derating.reachable_speed_rad_per_s / kPushed_ratio,
                    .lasting_A = kInfinite,
                    .at_standstill_A = kInfinite,
                    .held_rad_per_s = kInfinite};
  for (const std::vector<LastingPoint>& points : cases) {
    found.speed_rad_per_s = std::min(found.speed_rad_per_s, points.back().speed_rad_per_s);
  }
  for (const std::vector<LastingPoint>& points : cases) {
    found.lasting_A = std::min(found.lasting_A, lasting_at_A(points, found.speed_rad_per_s));
    found.at_standstill_A = std::min(found.at_standstill_A, lasting_at_A(points, 0.0));
    found.held_rad_per_s = std::min(found.held_rad_per_s, held_speed_rad_per_s(points, found.needed_A));
  }
  return found;
}

void require_own_friction(const Derating& derating) {
  const std::optional<OwnFriction> found = own_friction(derating);
  if (!found || found->holds()) {
    return;
  }
  constexpr double kRounding = 1e-6;
  const double held_V = std::floor(10.0 * found->held_rad_per_s * derating.torque_constant_Nm_per_A + kRounding) / 10.0;
  constexpr double kLeastLimit_V = 0.5;  // of [drive] voltage_limit
  const std::string slower =
      held_V >= kLeastLimit_V
          ? fmt::format(", or limit the speed to {:.0f} rad/s with [drive] voltage_limit = \"{:.1f} V\" in the robot's file",
                        found->held_rad_per_s, held_V)
          : std::string();
  throw base::Failure(
      base::ExitCode::limit_exceeded,
      fmt::format(
          "{}: the motor cannot hold its own friction: at {:.0f} rad/s its continuous current is {:.2f} A ({:.2f} A at standstill), "
          "but it needs its no-load current of {:.2f} A to turn; expected a continuous current of at least that up to the no-load "
          "speed of {:.0f} rad/s on a full battery; check no_load_current and winding_limit, use a lower --ambient or "
          "--confidence{}",
          derating.motor_id, found->speed_rad_per_s, found->lasting_A, found->at_standstill_A, found->needed_A,
          derating.reachable_speed_rad_per_s / kPushed_ratio, slower));
}

}  // namespace heatsoak::derate
