// Laws outside the catalogue. Each depends on a logged signal.
#include <cmath>
#include <memory>

#include "effects.h"

namespace heatsoak::suite {
namespace {

/// Adds heat to the stator.
std::function<void(Motor&, double)> warms_stator(std::function<double(const Motor&, const Instant&)> heat) {
  return [=](Motor& motor, double strength) {
    const Motor before = motor;
    motor.network.laws.emplace_back([=](const Instant& now, std::span<const double>, HeatBook& book) {
      source(before.stator, strength * before.nominal.copper_W() * heat(before, now), book);
    });
  };
}

double bump(double at, double centre, double width) { return std::exp(-0.5 * std::pow((at - centre) / width, 2.0)); }

double top_ratio(const Motor& motor, const Instant& now) { return now.speed_rad_per_s / motor.nominal.top_speed_rad_per_s; }

/// A rattle that begins above 65 % of the top speed and lasts until the speed is below 25 %.
void add_latch(Motor& motor, double strength) {
  const Motor before = motor;
  // One copy of the motor simulates one run at a time; a rest at the start of a run ends the rattle.
  const auto rattles = std::make_shared<bool>(false);
  motor.network.laws.emplace_back([=](const Instant& now, std::span<const double>, HeatBook& book) {
    const double ratio = std::abs(top_ratio(before, now));
    *rattles = ratio > 0.65 || (*rattles && ratio > 0.25);
    source(before.stator, *rattles ? 0.35 * strength * before.nominal.copper_W() : 0.0, book);
  });
}

/// A fan that the logged duty drives: it hardly blows below a third, then fully.
void add_fan(Motor& motor, double strength) {
  const Motor before = motor;
  motor.network.laws.emplace_back([=](const Instant& now, std::span<const double> temperature_C, HeatBook& book) {
    const double share = 1.0 / (1.0 + std::exp(-(now.fan_ratio - 0.45) / 0.06));
    const double conductance_W_per_K = 0.5 * strength / before.nominal.air_K_per_W;
    to_air(before.stator, conductance_W_per_K * share * (before.stator_C(temperature_C) - now.ambient_C), book);
  });
}

/// Copper loss that rises in a band of speeds, as with a resonance between controller and winding.
void add_copper_resonance(Motor& motor, double strength) {
  const Motor before = motor;
  motor.network.laws.emplace_back([=](const Instant& now, std::span<const double> temperature_C, HeatBook& book) {
    const double rise = 1.2 * strength * bump(std::abs(top_ratio(before, now)), 0.45, 0.12);
    source(before.winding, rise * copper_W(before, now, temperature_C), book);
  });
}

}  // namespace

const std::vector<EffectKind>& outside_effects() {
  static const std::vector<EffectKind> kEffects{
      {"threshold_in_current", "stator", "0.5 P above 1.1 I_n", {}, {"current"}, warms_stator([](const Motor& m, const Instant& now) {
         return 0.5 / (1.0 + std::exp(-(std::abs(now.current_A) / m.nominal.nominal_current_A - 1.1) / 0.05));
       })},
      {"resonance_over_speed",
       "stator",
       "0.6 P in a band about half of the top speed",
       {},
       {"speed"},
       warms_stator([](const Motor& m, const Instant& now) { return 0.6 * bump(std::abs(top_ratio(m, now)), 0.5, 0.1); })},
      {"rattle_with_hysteresis", "stator", "0.35 P from 65 % of the top speed until 25 %", {}, {"speed"}, add_latch},
      {"floor_friction",
       "stator",
       "0.1 P times the square of the vehicle's speed above 1.2 m/s",
       {},
       {"vehicle_speed"},
       warms_stator([](const Motor&, const Instant& now) { return 0.1 * std::pow(std::max(0.0, now.vehicle_speed_m_per_s - 1.2), 2.0); })},
      {"fan_cooling", "stator", "0.5 G above a fan duty of 0.45", {}, {"fan"}, add_fan},
      {"one_way_drag", "stator", "0.5 P w, forwards only", {}, {"speed"}, warms_stator([](const Motor& m, const Instant& now) {
         return 0.5 * std::max(0.0, top_ratio(m, now));
       })},
      {"regulator_over_voltage",
       "stator",
       "0.06 P per 2 % of bus voltage above 98 % of nominal",
       {},
       {"bus"},
       warms_stator([](const Motor& m, const Instant& now) { return 3.0 * std::max(0.0, now.bus_V / m.nominal.bus_V - 0.98); })},
      {"copper_resonance",
       "winding",
       "1.2 copper loss in a band about 45 % of the top speed",
       {},
       {"speed", "current"},
       add_copper_resonance},
  };
  return kEffects;
}

}  // namespace heatsoak::suite
