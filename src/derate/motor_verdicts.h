// Drawn motors during the search of the safety factor: counts those that exceed a limit without simulating known results again.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "derate/guarantee.h"

namespace heatsoak::derate {

/// Assumes that a motor which keeps its limits at one safety factor also keeps them at every larger one, in each use. At another factor
/// only the motors and uses whose result is unknown are simulated. If this holds, the count is that of check(), which simulates all of
/// them, except for rounding: the integration step may differ, because other motors share a block.
class MotorVerdicts {
 public:
  /// Returns the use of the pattern with this index, simulated with the guard for the present safety factor.
  using Play = std::function<const UsePlayed&(std::size_t index)>;
  /// Receives the number of motors that were simulated through one use since the last call.
  using Simulated = std::function<void(std::size_t motors)>;

  /// Draws options.samples motors from the random streams from `first_stream` on.
  MotorVerdicts(const motor::Motor& motor, const TemperatureLimits& limits, const GuaranteeOptions& options, std::uint64_t first_stream,
                Simulated simulated = {});

  /// Returns how many motors exceed a limit in at least one use. Calls `play` only for uses that are needed, from one thread.
  int count_over(double safety_factor, std::span<const LoadPattern> patterns, const Play& play);

  /// Returns an estimate of the smallest safety factor at which at most `most_over` motors exceed a limit; nothing if unknown. A motor's
  /// rise is about inversely proportional to the factor, so the estimate is close if that of the last count was.
  [[nodiscard]] std::optional<double> expected_ratio(int most_over) const;

 private:
  /// Results of one load pattern.
  struct Known {
    LoadPattern pattern;
    std::vector<double> kept_from_ratio;  ///< per motor: smallest safety factor at which it kept its limits; infinite: unknown
    int over = 0;                         ///< motors that exceeded a limit in this use so far
  };
  Known& known(const LoadPattern& pattern);
  void simulate(const UsePlayed& use, double safety_factor, Known& known, std::vector<std::size_t>& undecided);

  TemperatureLimits limits_;
  int threads_ = 0;
  Simulated simulated_;
  std::vector<thermal::Network> motors_;
  std::vector<double> over_up_to_ratio_;  ///< per motor: largest safety factor at which it exceeded a limit; 0: unknown
  double last_ratio_ = 1.0;               ///< safety factor of the last count
  /// Per motor at that factor: MotorPeak::limit_use_ratio of the simulated uses; 0 if none; infinite if it exceeds a limit by inference.
  std::vector<double> limit_use_ratio_;
  std::vector<Known> known_;
};

}  // namespace heatsoak::derate
