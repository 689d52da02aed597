#include "calibration/effect_signals.h"

#include <algorithm>
#include <set>

namespace heatsoak::calibration {
std::vector<EffectNeeds> needs_of(const estimation::Model& model) {
  std::vector<EffectNeeds> all;
  for (const thermal::EffectInPlace& effect : model.network.effects()) {
    std::vector<double> values;
    for (const int place : effect.parameter_index) {
      values.push_back(model.values[static_cast<std::size_t>(place)]);
    }
    all.push_back({effect.name, effect.type->needed_with(values)});
  }
  return all;
}

std::vector<EffectNeeds> needs_of(const motor::Motor& motor) {
  std::vector<EffectNeeds> all;
  for (const motor::MotorEffect& effect : motor.effects) {
    all.push_back({effect.name, effect.type->needed_with(effect.values()), is_remaining_loss(effect)});
  }
  return all;
}

EffectSignals effect_signals(std::span<const EffectNeeds> needs, std::span<const recording::Recording> recordings,
                             const estimation::MeasuredRunOptions& how) {
  std::set<thermal::Signal> logged;
  for (const recording::Recording& each : recordings) {
    const std::vector<thermal::Signal> signals = estimation::signals_of(each, how);
    logged.insert(signals.begin(), signals.end());
  }
  const bool is_unread = how.ignores_current && std::ranges::any_of(recordings, [](const recording::Recording& each) {
                           return estimation::has_signal(each, thermal::Signal::current);
                         });
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
      const bool lacks_current = std::ranges::find(lacking, thermal::Signal::current) != lacking.end();
      all.missing.push_back({std::move(lacking), each.effect, {}, is_unread && lacks_current, each.needs_all});
    }
  }
  all.found.assign(found.begin(), found.end());
  return all;
}

void need_signals_of_effects(const motor::Motor& motor, const recording::Recording& recording, estimation::MeasuredRunOptions& how) {
  for (const thermal::Signal signal : effect_signals(needs_of(motor), {&recording, 1}, how).found) {
    if (std::ranges::find(how.needed, signal) == how.needed.end()) {
      how.needed.push_back(signal);
    }
  }
}

std::vector<SignalsMissing> missing_signals(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                                            const estimation::MeasuredRunOptions& how) {
  const std::vector<EffectNeeds> needs = needs_of(motor);
  std::vector<SignalsMissing> all = effect_signals(needs, recordings, how).missing;
  const std::size_t in_none = all.size();
  for (const recording::Recording& recording : recordings) {
    for (SignalsMissing& each : effect_signals(needs, {&recording, 1}, how).missing) {
      const auto is_known = [&](const SignalsMissing& known) { return known.effect == each.effect && known.signals == each.signals; };
      if (std::none_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(in_none), is_known)) {
        each.recording = recording.name;
        all.push_back(std::move(each));
      }
    }
  }
  return all;
}

}  // namespace heatsoak::calibration
