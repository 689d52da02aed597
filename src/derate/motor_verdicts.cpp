#include "derate/motor_verdicts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace heatsoak::derate {

MotorVerdicts::MotorVerdicts(const motor::Motor& motor, const TemperatureLimits& limits, const GuaranteeOptions& options,
                             std::uint64_t first_stream, Simulated simulated)
    : limits_(limits),
      threads_(options.threads),
      simulated_(std::move(simulated)),
      over_up_to_ratio_(static_cast<std::size_t>(options.samples), 0.0),
      limit_use_ratio_(over_up_to_ratio_.size(), 0.0) {
  for (std::size_t begin = 0; begin < over_up_to_ratio_.size(); begin += base::kLanes) {
    std::ranges::move(drawn_networks(motor, options.seed, first_stream + begin), std::back_inserter(motors_));
  }
}

int MotorVerdicts::count_over(double safety_factor, std::span<const LoadPattern> patterns, const Play& play) {
  last_ratio_ = safety_factor;
  std::vector<std::size_t> undecided;
  for (std::size_t motor = 0; motor < over_up_to_ratio_.size(); ++motor) {
    const bool is_over = safety_factor <= over_up_to_ratio_[motor];
    limit_use_ratio_[motor] = is_over ? std::numeric_limits<double>::infinity() : 0.0;
    if (!is_over) {
      undecided.push_back(motor);
    }
  }
  std::vector<std::size_t> order(patterns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const LoadPattern& each : patterns) {
    known(each);
  }
  // The use in which most motors exceeded a limit decides most of them, so that the others need not simulate those.
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t index) { return known(patterns[index]).over; });
  for (const std::size_t index : order) {
    Known& of_use = known(patterns[index]);
    if (std::ranges::any_of(undecided, [&](std::size_t motor) { return safety_factor < of_use.kept_from_ratio[motor]; })) {
      simulate(play(index), safety_factor, of_use, undecided);
    }
  }
  return static_cast<int>(std::ranges::count_if(over_up_to_ratio_, [&](double factor) { return safety_factor <= factor; }));
}

std::optional<double> MotorVerdicts::expected_ratio(int most_over) const {
  std::vector<double> descending = limit_use_ratio_;
  std::ranges::sort(descending, std::greater<>());
  const double use_ratio = descending[std::min(static_cast<std::size_t>(most_over), descending.size() - 1)];
  return use_ratio > 0.0 && std::isfinite(use_ratio) ? std::optional(last_ratio_ * use_ratio) : std::nullopt;
}

MotorVerdicts::Known& MotorVerdicts::known(const LoadPattern& pattern) {
  const auto found = std::ranges::find(known_, pattern, &Known::pattern);
  if (found != known_.end()) {
    return *found;
  }
  known_.push_back({pattern, std::vector<double>(over_up_to_ratio_.size(), std::numeric_limits<double>::infinity()), 0});
  return known_.back();
}

/// Removes the motors that exceed a limit from `undecided`.
void MotorVerdicts::simulate(const UsePlayed& use, double safety_factor, Known& known, std::vector<std::size_t>& undecided) {
  std::vector<std::size_t> motors;
  std::ranges::copy_if(undecided, std::back_inserter(motors),
                       [&](std::size_t motor) { return safety_factor < known.kept_from_ratio[motor]; });
  std::vector<std::array<MotorPeak, base::kLanes>> found((motors.size() + base::kLanes - 1) / base::kLanes);
  const base::Progress progress = simulated_ ? [this](std::size_t, std::size_t) { simulated_(base::kLanes); } : base::Progress();
  base::in_parallel(found.size(), threads_, 0, found.size(), progress, [&](std::size_t block) {
    std::vector<thermal::Network> networks;
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      networks.push_back(motors_[motors[std::min(block * base::kLanes + lane, motors.size() - 1)]]);
    }
    found[block] = peaks(networks, limits_, {&use, 1});
  });
  for (std::size_t i = 0; i < motors.size(); ++i) {
    const std::size_t motor = motors[i];
    const MotorPeak& peak = found[i / base::kLanes][i % base::kLanes];
    limit_use_ratio_[motor] = std::max(limit_use_ratio_[motor], peak.limit_use_ratio);
    if (peak.is_over) {
      over_up_to_ratio_[motor] = safety_factor;
      ++known.over;
    } else {
      known.kept_from_ratio[motor] = safety_factor;
    }
  }
  std::erase_if(undecided, [&](std::size_t motor) { return safety_factor <= over_up_to_ratio_[motor]; });
}

}  // namespace heatsoak::derate
