// Motors that a restore of the guard must not leave colder than they are: with slow bodies, heat of their own and hot neighbours.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "guarded_motor.h"
#include "thermal/transient.h"

namespace heatsoak::derate {

struct PoweredOffCase {
  std::string name;
  std::vector<std::string> effects;  ///< lines of the motor's file, from effect_lines()
  bool has_neighbour = false;
  bool fits_integers = true;  ///< false: the integer form lacks a signal or a function
  double enlarged_K = 0.0;    ///< largest amount by which the resting temperatures are above the steady state
  std::vector<double> ages_h = {0.0};
  double simulated_s = 600.0;  ///< time that the restore simulates at least
};

/// Returns the lines of an effect with estimated values; `node` is an optional line that places it.
inline std::string effect_lines(const std::string& name, const std::string& type,
                                const std::vector<std::pair<std::string, std::string>>& values, const std::string& node = "") {
  std::string text = fmt::format("[effects.{}]\ntype = \"{}\"\n{}", name, type, node);
  for (const auto& [key, value] : values) {
    text += fmt::format("{} = {{ value = \"{}\", origin = \"estimated\", derivation = \"a test\" }}\n", key, value);
  }
  return text;
}

inline std::string slow_body(const std::string& name, const std::string& heat_capacity) {
  return effect_lines(name, "third_node", {{"heat_capacity", heat_capacity}, {"conductance", "0.3 W/K"}, {"leak_ratio", "0.2"}});
}

inline std::string ageing(const std::string& conductance, const std::string& fresh_share) {
  return effect_lines("contact", "contact_ageing", {{"conductance", conductance}, {"time_constant", "2 h"}, {"fresh_share", fresh_share}});
}

inline const std::vector<PoweredOffCase>& powered_off_cases() {
  static const std::vector<PoweredOffCase> cases{
      {"heat_and_slow_body", {slow_body("chassis", "4000 J/K"), effect_lines("board", "constant_heat", {{"power", "3 W"}})}},
      {"two_slow_bodies", {slow_body("chassis", "4000 J/K"), slow_body("frame", "900 J/K")}},
      {"neighbour", {slow_body("chassis", "200 J/K"), effect_lines("next", "neighbour_coupling", {{"conductance", "0.05 W/K"}})}, true, false},
      // The contact opens as it warms, so the winding's own heat needs a larger difference.
      {"opening_contact",
       {effect_lines("contact", "contact_temperature_dependence",
                     {{"conductance", "0.1 W/K"}, {"midpoint", "90 degC"}, {"steepness", "-0.1 1/K"}}),
        effect_lines("leak", "constant_heat", {{"power", "1 W"}}, "heated = \"winding\"\n")},
       false,
       false,
       3.0},
      {"air_and_radiation",
       {effect_lines("air", "natural_convection", {{"conductance", "0.1 W/K"}, {"exponent", "0.25"}}),
        effect_lines("shine", "radiation", {{"emissive_area", "0.01 m2"}}), effect_lines("board", "constant_heat", {{"power", "2 W"}})},
       false,
       false},
      {"contact_that_opens_with_age", {ageing("0.1 W/K", "1")}, false, false, 3.0, {0.0, 1.0, 1e5}},
      {"contact_that_closes_with_age", {ageing("0.2 W/K", "0")}, false, false, 3.0, {0.0, 1.0, 1e5}},
      // Stiffer the cooler it is: the time constant shrinks while the motor cools.
      {"stiffening_contact",
       {effect_lines("contact", "contact_law", {{"conductance", "1 W/K"}, {"mean_ratio", "1"}, {"difference_ratio", "0.05"}})},
       false,
       false,
       0.0,
       {0.0},
       60.0}};
  return cases;
}

/// A motor of powered_off_cases() with its guard, whose safety factor on heat is 1, so that the motor is its own reference.
struct PoweredOffMotor {
  explicit PoweredOffMotor(const PoweredOffCase& of)
      : has_neighbour(of.has_neighbour),
        enlarged_K(of.enlarged_K),
        ages_h(of.ages_h),
        simulated_s(of.simulated_s),
        guarded(motor_of(of), rules_for(motor_of(of)), 1.0),
        derating(derating_of(guarded)) {
    derating.motor_id = of.name;
  }

  [[nodiscard]] std::size_t nodes() const { return static_cast<std::size_t>(guarded.network.state_count()); }

  /// Highest temperatures over all ages, see cooled_at().
  [[nodiscard]] thermal::TransientResult cooled(const std::vector<double>& start_C, double elapsed_s) const {
    thermal::TransientResult highest = cooled_at(ages_h.front(), start_C, elapsed_s);
    for (const double age_h : ages_h) {
      const thermal::TransientResult each = cooled_at(age_h, start_C, elapsed_s);
      for (std::size_t node = 0; node < nodes(); ++node) {
        highest.end_C[node] = std::max(highest.end_C[node], each.end_C[node]);
        highest.peak_C[node] = std::max(highest.peak_C[node], each.peak_C[node]);
      }
    }
    return highest;
  }

  /// Solution without current in the hottest air, beside a neighbour at the winding limit.
  [[nodiscard]] thermal::TransientResult cooled_at(double age_h, const std::vector<double>& start_C, double elapsed_s) const {
    thermal::OperatingPoint<double> at;
    at.age_h = age_h;
    at.ambient_C = guarded.rules.hottest_ambient_C;
    if (has_neighbour) {
      at.neighbour_C = guarded.rules.limits.winding_C;
      at.known |= thermal::kNeighbour;
    }
    thermal::TransientOptions options;
    options.start_C = start_C;
    // The explicit method takes steps of the fastest time constant, also when only the slowest body still cools.
    constexpr double kStiff_s = 3600.0;
    options.method = elapsed_s >= kStiff_s ? ode::OdeMethod::cvodes_bdf : ode::OdeMethod::arkode_erk;
    return thermal::run_transient(guarded.network, guarded.network.values(), std::vector<thermal::Interval>{{elapsed_s, at}}, options);
  }

  bool has_neighbour;
  double enlarged_K;
  std::vector<double> ages_h;
  double simulated_s;
  GuardedMotor guarded;
  Derating derating;

 private:
  static motor::Motor motor_of(const PoweredOffCase& of) {
    std::string lines;
    for (const std::string& each : of.effects) {
      lines += each + "\n";
    }
    return ecx_32_with(lines);
  }
};

/// Temperatures at which a motor may lose its power; hot and cold nodes in any order.
inline std::vector<std::vector<double>> saved_temperatures_C(std::size_t nodes, int draws) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> temperature_C(20.0, 120.0);
  std::vector<std::vector<double>> all{std::vector<double>(nodes, 25.0), std::vector<double>(nodes, 40.0)};
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<double>& state_C = all.emplace_back();
    for (std::size_t node = 0; node < nodes; ++node) {
      state_C.push_back(temperature_C(engine));
    }
  }
  return all;
}

/// Compares restored temperatures with the solution; a negative time is unknown. No node may be colder. Within the simulated time it may not
/// be warmer either, and later not far above its possible temperatures. `restored_C` returns the restored temperatures for saved ones.
template <class Restored>
void expect_safe_and_useful(const PoweredOffMotor& motor, const Restored& restored_C) {
  const std::vector<double> rest_C = motor.cooled(std::vector<double>(motor.nodes(), 60.0), 1e6).end_C;
  for (const std::vector<double>& saved_C : saved_temperatures_C(motor.nodes(), 3)) {
    double above_K = 0.0;
    for (std::size_t node = 0; node < motor.nodes(); ++node) {
      above_K = std::max(above_K, saved_C[node] - rest_C[node]);
    }
    for (const double elapsed_s : {2.0, 60.0, 600.0, 3600.0, 100'000.0, -1.0}) {
      const thermal::TransientResult exact = motor.cooled(saved_C, elapsed_s < 0.0 ? 1e6 : elapsed_s);
      const std::vector<double> found_C = restored_C(saved_C, elapsed_s);
      for (std::size_t node = 0; node < motor.nodes(); ++node) {
        EXPECT_GE(found_C[node], (elapsed_s < 0.0 ? exact.peak_C : exact.end_C)[node] - 0.003)
            << motor.derating.motor_id << ", " << elapsed_s << " s, node " << node << ", saved " << testing::PrintToString(saved_C);
        const bool is_simulated = elapsed_s >= 0.0 && elapsed_s <= motor.simulated_s && motor.ages_h.size() == 1U;
        EXPECT_LE(found_C[node], is_simulated ? exact.end_C[node] + 0.15 : std::max(saved_C[node], rest_C[node] + above_K) + 0.2 + motor.enlarged_K)
            << motor.derating.motor_id << ", " << elapsed_s << " s, node " << node << ", saved " << testing::PrintToString(saved_C);
      }
    }
  }
}

}  // namespace heatsoak::derate
