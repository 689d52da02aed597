#include "adversary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "derate/held_current.h"
#include "robot/motor_drive.h"

namespace heatsoak::derate::studies {
namespace {

constexpr double kFastest_share = 0.98;

Segment random_segment(const BarrierRules& rules, base::Random& random) {
  constexpr double kShortest_s = 0.05;
  constexpr double kLongest_s = 300.0;
  Segment segment;
  segment.duration_s = kShortest_s * std::pow(kLongest_s / kShortest_s, random.uniform());
  const double kind = random.uniform();
  segment.share = kind < 0.65 ? 1.0 : kind < 0.9 ? 0.0 : random.uniform();
  const double speed = random.uniform();
  segment.speed_rad_per_s = rules.most_speed_rad_per_s * (speed < 0.25  ? 0.0
                                                          : speed < 0.5 ? kFastest_share
                                                                        : kFastest_share * random.uniform());
  segment.is_braking = random.uniform() < 0.3;
  segment.ambient_C = rules.hottest_ambient_C;
  return segment;
}

/// Extends or cuts the script to kScript_s.
void complete(Script& script, const BarrierRules& rules, base::Random& random) {
  double sum_s = 0.0;
  for (std::size_t i = 0; i < script.segments.size(); ++i) {
    sum_s += script.segments[i].duration_s;
    if (sum_s >= kScript_s) {
      script.segments[i].duration_s -= sum_s - kScript_s;
      script.segments.resize(i + 1);
      return;
    }
  }
  script.segments.push_back(random_segment(rules, random));
  complete(script, rules, random);
}

}  // namespace

Script bang_bang(const BarrierRules& rules, base::Random& random) {
  Script script{{}, rules.hottest_ambient_C, rules.hottest_ambient_C};
  complete(script, rules, random);
  return script;
}

Script mutated(const Script& script, const BarrierRules& rules, base::Random& random) {
  Script other = script;
  const int changes = 1 + static_cast<int>(4.0 * random.uniform());
  for (int i = 0; i < changes; ++i) {
    Segment& segment = other.segments[static_cast<std::size_t>(random.uniform() * static_cast<double>(other.segments.size()))];
    const double kind = random.uniform();
    if (kind < 0.5) {
      segment.duration_s *= std::exp(random.uniform() - 0.5);
    } else if (kind < 0.75) {
      segment.speed_rad_per_s = random_segment(rules, random).speed_rad_per_s;
    } else {
      segment = random_segment(rules, random);
    }
  }
  complete(other, rules, random);
  return other;
}

void step_ambient(Script& script, double coldest_C, const BarrierRules& rules, base::Random& random) {
  constexpr double kMean_s = 50.0;
  double left_s = 0.0;
  double ambient_C = rules.hottest_ambient_C;
  std::vector<Segment> cut;
  for (Segment segment : script.segments) {
    while (segment.duration_s > 0.0) {
      if (left_s <= 0.0) {
        left_s = -kMean_s * std::log(random.uniform());
        const double kind = random.uniform();
        ambient_C = kind < 0.4 ? rules.hottest_ambient_C : std::lerp(coldest_C, rules.hottest_ambient_C, random.uniform());
      }
      Segment piece = segment;
      piece.duration_s = std::min(left_s, segment.duration_s);
      piece.ambient_C = ambient_C;
      cut.push_back(piece);
      left_s -= piece.duration_s;
      segment.duration_s -= piece.duration_s;
    }
  }
  script.segments = std::move(cut);
  script.observer_start_C = script.motor_start_C = script.segments.front().ambient_C;
}

Script match(const duty::WheelDemand& wheel, const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules,
             double aggressiveness, double first_share) {
  Script script{{}, rules.hottest_ambient_C, rules.hottest_ambient_C};
  double sum_s = 0.0;
  for (auto i = static_cast<std::size_t>(first_share * static_cast<double>(wheel.bins.size())); sum_s < kScript_s; ++i) {
    const duty::LoadBin& bin = wheel.bins[i % wheel.bins.size()];
    Segment segment;
    segment.duration_s = std::min(bin.duration_s, kScript_s - sum_s);
    segment.wanted_A =
        aggressiveness * std::abs(robot::drive_point(motor.nominal, robot, {bin.torque_rms_Nm, bin.speed_rms_rad_per_s}).current_wanted_A);
    segment.speed_rad_per_s = std::min(kFastest_share * rules.most_speed_rad_per_s, robot.drive.gear_ratio * bin.speed_rms_rad_per_s);
    segment.is_braking = bin.torque_along_motion_Nm < 0.0;
    segment.ambient_C = rules.hottest_ambient_C;
    sum_s += segment.duration_s;
    script.segments.push_back(segment);
  }
  return script;
}

UsePlayed play(const Script& script, const Observer& observer, const CurrentTable& table, const motor::Motor& motor,
               const robot::Robot& robot, double period_s) {
  UsePlayed result;
  result.start_C = script.motor_start_C;
  ObserverRun<float> run(observer, static_cast<float>(period_s), static_cast<float>(script.observer_start_C));
  for (const Segment& segment : script.segments) {
    const double sign = segment.is_braking ? -1.0 : 1.0;
    const auto signals = [&](double current_A) {
      return Signals{sign * current_A, segment.speed_rad_per_s, segment.ambient_C, 0.0, segment.ambient_C, 0.0, 0.0};
    };
    HeldCurrent held;
    const auto end_interval = [&] {
      result.intervals.push_back({held.duration_s, operating_point<double>(motor.nominal, robot, signals(held.rms_A()))});
      held = {};
    };
    for (double left_s = segment.duration_s; left_s > 1e-9; left_s -= period_s) {
      const float allowed_A =
          table.allowed_A(static_cast<float>(segment.speed_rad_per_s), run.hottest_body_C(), run.state_C()[motor::states::winding]);
      const double current_A = std::min(segment.wanted_A, segment.share * static_cast<double>(allowed_A));
      if (held.is_over(current_A, segment.speed_rad_per_s)) {
        end_interval();
      }
      held.take(current_A, segment.speed_rad_per_s, period_s);
      std::array<float, observed::kSignalCount> guard_inputs{};
      std::ranges::transform(signals(current_A), guard_inputs.begin(), [](double value) { return static_cast<float>(value); });
      run.step(guard_inputs);
      result.winding_peak_C = std::max<double>(result.winding_peak_C, run.state_C()[motor::states::winding]);
    }
    if (held.duration_s > 0.0) {
      end_interval();
    }
  }
  return result;
}

std::string to_text(const Script& script, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, script.segments.size()); ++i) {
    const Segment& each = script.segments[i];
    text += fmt::format("{}{:.3g} s {} at {}{:.0f} rad/s", text.empty() ? "" : "; ", each.duration_s,
                        each.share == 0.0   ? "none"
                        : each.share == 1.0 ? "all"
                                            : fmt::format("{:.0f} %", 100.0 * each.share),
                        each.is_braking ? "-" : "", each.speed_rad_per_s);
  }
  return text + (script.segments.size() > most ? fmt::format("; … ({} in all)", script.segments.size()) : std::string());
}

}  // namespace heatsoak::derate::studies
