#include "calibration/effect_signals.h"

#include <algorithm>
#include <set>

namespace heatsoak::calibration {
namespace {

std::vector<thermal::Signal> without_copper_loss(std::vector<thermal::Signal> signals, HeatInput heat) {
  if (heat == HeatInput::input_power) {
    std::erase(signals, thermal::Signal::current);
  }
  return signals;
}

}  // namespace

std::vector<EffectNeeds> needs_of(const estimation::Model& model, HeatInput heat) {
  std::vector<EffectNeeds> all;
  for (const thermal::EffectInPlace& effect : model.network.effects()) {
    std::vector<double> values;
    for (const int place : effect.parameter_index) {
      values.push_back(model.values[static_cast<std::size_t>(place)]);
    }
    all.push_back({effect.name, without_copper_loss(effect.type->needed_with(values), heat)});
  }
  return all;
}

std::vector<EffectNeeds> needs_of(const motor::Motor& motor, HeatInput heat) {
  std::vector<EffectNeeds> all;
  for (const motor::MotorEffect& effect : motor.effects) {
    all.push_back({effect.name, without_copper_loss(effect.type->needed_with(effect.values()), heat)});
  }
  return all;
}

EffectSignals effect_signals(std::span<const EffectNeeds> needs, std::span<const recording::Recording> recordings,
                             const estimation::ShaftTorque& torque) {
  std::set<thermal::Signal> logged;
  for (const recording::Recording& each : recordings) {
    const std::vector<thermal::Signal> signals = estimation::signals_of(each, torque);
    logged.insert(signals.begin(), signals.end());
  }
  std::set<thermal::Signal> found;
  EffectSignals all;
  for (const EffectNeeds& each : needs) {
    std::vector<thermal::Signal> lacking;
    for (const thermal::Signal signal : each.signals) {
      if (logged.contains(signal)) {
        found.insert(signal);
      } else {
        lacking.push_back(signal);
      }
    }
    if (!lacking.empty()) {
      all.missing.push_back({std::move(lacking), each.effect, {}});
    }
  }
  all.found.assign(found.begin(), found.end());
  return all;
}

void need_signals_of_effects(const motor::Motor& motor, HeatInput heat, const recording::Recording& recording,
                             estimation::MeasuredRunOptions& how) {
  const std::vector<EffectNeeds> needs = needs_of(motor, heat);
  for (const thermal::Signal signal : effect_signals(needs, {&recording, 1}, how.torque).found) {
    if (std::ranges::find(how.needed, signal) == how.needed.end()) {
      how.needed.push_back(signal);
    }
  }
}

}  // namespace heatsoak::calibration
