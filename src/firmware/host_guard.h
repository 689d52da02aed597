// The thermal guard on the host: a robot_core::GuardModel made from a derating.
#pragma once

#include <array>
#include <vector>

#include "derate/plausible_range.h"
#include "robot_core/thermal_guard.h"

namespace heatsoak::firmware {

/// Owns the tables of one motor's guard and runs the observer's formula in single precision, bit-identical to the code generated for the
/// controller. The formula has scratch memory, so two threads must not step one HostGuard at once: give each thread a copy. A model() is
/// valid as long as its HostGuard.
class HostGuard {
 public:
  /// Throws Failure (bad_input) if the motor has more nodes than robot_core::kMostGuardNodes.
  explicit HostGuard(const derate::Derating& derating);
  HostGuard(const HostGuard& other);
  HostGuard& operator=(const HostGuard& other);
  ~HostGuard() = default;

  [[nodiscard]] const robot_core::GuardModel& model() const { return model_; }

 private:
  struct Law {
    explicit Law(const derate::Observer& observer);
    thermal::FormulaRun<float> run;
    std::vector<float> values;  ///< inputs of the formula: signals, then temperatures
    std::vector<float> rates_K_per_s;
  };
  static void rates(const void* context, const float* signals, const float* state_C, float* rate_K_per_s);
  void point_to_own();

  robot_core::GuardModel model_;
  std::vector<float> speed_rad_per_s_;
  std::vector<float> stator_C_;
  std::vector<float> winding_C_;
  std::vector<float> heat_per_ohm_A2_;
  std::array<derate::PlausibleRange, derate::observed::kSignalCount> plausible_ranges_;
  mutable Law law_;
};

}  // namespace heatsoak::firmware
