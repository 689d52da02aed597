#include "estimation/turning_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "estimation/fit.h"

namespace heatsoak::estimation {
namespace {

/// Weight of the neighbours' means in the speed at the ends of a row. This value gives no bias for ramps shorter than a row that are
/// separated by pauses of random length.
constexpr double kTowardsNeighbour_share = 0.85;

/// Mean of |ω| for a linear change of ω.
double mean_magnitude(double from, double to) {
  return from * to < 0.0 ? (from * from + to * to) / (2.0 * (std::abs(from) + std::abs(to))) : 0.5 * std::abs(from + to);
}

double mean_square(double from, double to) { return (from * from + from * to + to * to) / 3.0; }

struct Neighbours {
  double before_rad_per_s, own_rad_per_s, behind_rad_per_s;
};

/// Calls `visit` for each interval that is one row of the log and in which the motor may reverse.
template <class Visit>
void each_turning(const MeasuredRun& run, const Visit& visit) {
  for (std::size_t k = 1; k + 1 < run.at.size(); ++k) {
    const thermal::OperatingPoint<double>& at = run.at[k];
    const bool is_one_row = at.speed_mean_rad_per_s <= std::abs(at.velocity_rad_per_s) + 1e-9;
    const auto [least, most] = std::minmax({run.at[k - 1].velocity_rad_per_s, at.velocity_rad_per_s, run.at[k + 1].velocity_rad_per_s});
    if (is_one_row && least < 0.0 && most > 0.0) {
      visit(k, Neighbours{run.at[k - 1].velocity_rad_per_s, at.velocity_rad_per_s, run.at[k + 1].velocity_rad_per_s});
    }
  }
}

}  // namespace

bool may_turn_within_rows(const MeasuredRun& run) {
  bool turns = false;
  each_turning(run, [&](std::size_t, const Neighbours&) { turns = true; });
  return turns;
}

MeasuredRun turning_within_rows(MeasuredRun run) {
  std::vector<thermal::OperatingPoint<double>> at = run.at;
  each_turning(run, [&](std::size_t k, const Neighbours& speed) {
    const double mean = speed.own_rad_per_s;
    const double from = std::lerp(mean, speed.before_rad_per_s, kTowardsNeighbour_share);
    const double to = std::lerp(mean, speed.behind_rad_per_s, kTowardsNeighbour_share);
    const auto [least, most] = std::minmax({speed.before_rad_per_s, mean, speed.behind_rad_per_s});
    const double middle = std::clamp(2.0 * mean - 0.5 * (from + to), least, most);
    at[k].speed_mean_rad_per_s = std::max(std::abs(mean), 0.5 * (mean_magnitude(from, middle) + mean_magnitude(middle, to)));
    at[k].speed_rms_rad_per_s =
        std::max(at[k].speed_mean_rad_per_s, std::sqrt(0.5 * (mean_square(from, middle) + mean_square(middle, to))));
  });
  run.at = std::move(at);
  return run;
}

std::vector<MeasuredRun> turning_within_rows(std::vector<MeasuredRun> runs) {
  for (MeasuredRun& run : runs) {
    run = turning_within_rows(std::move(run));
  }
  return runs;
}

std::optional<bool> settle_turning_rows(const Model& model, std::vector<MeasuredRun>& runs) {
  if (std::ranges::none_of(runs, may_turn_within_rows)) {
    return std::nullopt;
  }
  std::vector<MeasuredRun> turning = turning_within_rows(runs);
  std::array<double, 2> nats{};
  base::in_parallel(nats.size(), 0, [&](std::size_t i) { nats[i] = evidence_nats(model, i == 0 ? runs : turning); });
  const bool is_linear = nats[1] > nats[0];
  if (is_linear) {
    runs = std::move(turning);
  }
  return is_linear;
}

}  // namespace heatsoak::estimation
