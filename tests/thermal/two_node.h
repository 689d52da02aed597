// Closed-form solution of the two-node motor, the reference of this folder's tests.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "thermal/network.h"
#include "thermal/transient.h"

namespace heatsoak::thermal {

enum Node { winding, stator, ambient };

/// Under a constant current the network is linear, also with α: dT/dt = A·T + b, T(t) = T∞ + exp(A·t)·(T0 − T∞). All values are long
/// double.
struct TwoNode {
  double resistance_25C_ohm = 1.0;
  double temperature_coefficient_per_K = 0.0039;
  double drag_torque_Nm = 0.0;
  double winding_stator_K_per_W = 4.0;
  double stator_ambient_K_per_W = 3.0;
  double winding_J_per_K = 3.0;
  double stator_J_per_K = 30.0;

  using Pair = std::array<long double, 2>;  ///< winding, stator

  [[nodiscard]] Network network() const {
    Network made;
    made.add_node("winding", winding_J_per_K);
    made.add_node("stator", stator_J_per_K);
    const auto add = [&made](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
      made.add_effect(name, *find_effect(type), nodes, parameters);
    };
    add("copper", "copper_loss", {"winding"}, {resistance_25C_ohm, temperature_coefficient_per_K});
    add("drag", "no_load_loss", {"stator"}, {drag_torque_Nm});
    add("inner", "conduction", {"winding", "stator"}, {winding_stator_K_per_W});
    add("outer", "conduction", {"stator", "ambient"}, {stator_ambient_K_per_W});
    return made;
  }

  struct Linear {
    long double a, b, c, d;  ///< A, row by row
    Pair constant;           ///< b
  };
  [[nodiscard]] Linear linear(const OperatingPoint<double>& at) const {
    const long double heat_W = static_cast<long double>(at.current_rms_A) * at.current_rms_A * resistance_25C_ohm;
    const long double inner = 1.0L / winding_stator_K_per_W;
    const long double outer = 1.0L / stator_ambient_K_per_W;
    const long double alpha = temperature_coefficient_per_K;
    return {(heat_W * alpha - inner) / winding_J_per_K,
            inner / winding_J_per_K,
            inner / stator_J_per_K,
            -(inner + outer) / stator_J_per_K,
            {heat_W * (1.0L - 25.0L * alpha) / winding_J_per_K,
             (static_cast<long double>(drag_torque_Nm) * at.speed_mean_rad_per_s + outer * at.ambient_C) / stator_J_per_K}};
  }

  [[nodiscard]] Pair rest_C(const OperatingPoint<double>& at) const {
    const Linear x = linear(at);
    const long double determinant = x.a * x.d - x.b * x.c;
    return {-(x.d * x.constant[0] - x.b * x.constant[1]) / determinant, -(x.a * x.constant[1] - x.c * x.constant[0]) / determinant};
  }

  /// Positive if the copper loss grows faster than the heat that can be removed.
  [[nodiscard]] std::array<long double, 2> eigenvalues_per_s(const OperatingPoint<double>& at) const {
    const Linear x = linear(at);
    const long double middle = 0.5L * (x.a + x.d);
    const long double distance = std::sqrt(0.25L * (x.a - x.d) * (x.a - x.d) + x.b * x.c);
    return {middle + distance, middle - distance};
  }

  [[nodiscard]] Pair after(long double time_s, Pair start_C, const OperatingPoint<double>& at) const {
    const Linear x = linear(at);
    const Pair rest = rest_C(at);
    const auto [slow, fast] = eigenvalues_per_s(at);
    const long double u = start_C[0] - rest[0];
    const long double v = start_C[1] - rest[1];
    // Sylvester: exp(A·t) = (e^(slow·t)·(A − fast) − e^(fast·t)·(A − slow)) / (slow − fast)
    const long double s = std::exp(slow * time_s) / (slow - fast);
    const long double f = std::exp(fast * time_s) / (slow - fast);
    return {rest[0] + s * ((x.a - fast) * u + x.b * v) - f * ((x.a - slow) * u + x.b * v),
            rest[1] + s * (x.c * u + (x.d - fast) * v) - f * (x.c * u + (x.d - slow) * v)};
  }

  [[nodiscard]] Pair rate_K_per_s(Pair state_C, const OperatingPoint<double>& at) const {
    const Linear x = linear(at);
    return {x.a * state_C[0] + x.b * state_C[1] + x.constant[0], x.c * state_C[0] + x.d * state_C[1] + x.constant[1]};
  }

  [[nodiscard]] Pair after(std::span<const Interval> intervals, Pair start_C) const {
    for (const Interval& interval : intervals) {
      start_C = after(interval.duration_s, start_C, interval.at);
    }
    return start_C;
  }

  /// Above this current there is no steady state.
  [[nodiscard]] double critical_current_A() const {
    return std::sqrt(1.0 / (temperature_coefficient_per_K * resistance_25C_ohm * (winding_stator_K_per_W + stator_ambient_K_per_W)));
  }
};

/// Returns the zero of a function with one change of sign between `low` and `high`.
template <class Function>
long double bisected(long double low, long double high, const Function& function) {
  const bool rises = function(high) > 0.0L;
  for (int i = 0; i < 200; ++i) {
    const long double middle = 0.5L * (low + high);
    ((function(middle) > 0.0L) == rises ? high : low) = middle;
  }
  return 0.5L * (low + high);
}

/// Random numbers with a fixed seed.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double by_ratio(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  int below(int count) { return static_cast<int>(between(0.0, count - 1e-9)); }

  TwoNode motor() {
    return {.resistance_25C_ohm = by_ratio(0.05, 5.0),
            .temperature_coefficient_per_K = between(0.0, 0.006),
            .drag_torque_Nm = between(0.0, 0.02),
            .winding_stator_K_per_W = by_ratio(0.5, 10.0),
            .stator_ambient_K_per_W = by_ratio(0.5, 20.0),
            .winding_J_per_K = by_ratio(1.0, 15.0),
            .stator_J_per_K = by_ratio(10.0, 200.0)};
  }
  /// Draws at most 0.9 of the critical current, and a copper loss of at most 60 W.
  OperatingPoint<double> point(const TwoNode& motor) {
    const double most_A = std::min(0.9 * motor.critical_current_A(), std::sqrt(60.0 / motor.resistance_25C_ohm));
    const double speed_rad_per_s = between(0.0, 800.0);
    return {between(0.0, most_A), speed_rad_per_s, speed_rad_per_s, between(-10.0, 45.0)};
  }

 private:
  std::mt19937_64 engine_;
};

inline OperatingPoint<double> current_point(double current_A, double ambient_C = 25.0) { return {current_A, 0.0, 0.0, ambient_C}; }

inline std::vector<Interval> on_off(double current_A, double on_s, double off_s, int cycles, double ambient_C = 25.0) {
  std::vector<Interval> intervals;
  for (int i = 0; i < cycles; ++i) {
    intervals.push_back({on_s, current_point(current_A, ambient_C)});
    intervals.push_back({off_s, current_point(0.0, ambient_C)});
  }
  return intervals;
}

}  // namespace heatsoak::thermal
