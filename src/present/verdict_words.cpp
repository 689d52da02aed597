#include "present/verdict_words.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/counted.h"
#include "select/prospect.h"

namespace heatsoak::present {

ShownVerdict shown_verdict(const select::MotorEvaluation& motor) {
  if (motor.samples == 0) {
    return motor.verdict == select::Verdict::infeasible ? ShownVerdict::nominal_short
           : motor.verdict == select::Verdict::fail     ? ShownVerdict::nominal_over
                                                        : ShownVerdict::nominal_within;
  }
  if (motor.samples_needed) {
    return ShownVerdict::undecided;
  }
  constexpr std::array<ShownVerdict, 4> kShown{ShownVerdict::pass, ShownVerdict::marginal, ShownVerdict::fail, ShownVerdict::infeasible};
  return kShown.at(static_cast<std::size_t>(motor.verdict));
}

std::string_view to_string(ShownVerdict verdict) {
  constexpr std::array<std::string_view, 8> kWords{"pass", "undecided", "marginal", "fail", "infeasible", "within", "over", "short"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

Tone tone_of(ShownVerdict verdict) {
  constexpr std::array<Tone, 8> kTones{Tone::good, Tone::undecided, Tone::undecided, Tone::bad,
                                       Tone::bad,  Tone::undecided, Tone::bad,       Tone::bad};
  return kTones.at(static_cast<std::size_t>(verdict));
}

Tone tone_of(select::Verdict verdict) {
  return verdict == select::Verdict::pass ? Tone::good : verdict == select::Verdict::marginal ? Tone::undecided : Tone::bad;
}

std::string passing_text(std::ptrdiff_t passing, std::size_t all, std::string_view what) {
  return fmt::format("{} of {} pass{}", passing, base::counted(all, what), passing == 1 || all == 1 ? "es" : "");
}

std::string load_words(const duty::Duty& duty) {
  return duty.shape_data->depends_on_robot()
             ? duty.id
             : fmt::format("{} (a fixed wheel load: mass and wheel size of the robot do not matter)", duty.id);
}

std::string percent_range(const select::Interval95& range) {
  return fmt::format("{:.0f}…{:.0f}", std::floor(100.0 * range.low), std::ceil(100.0 * range.high));
}

std::optional<OpenShare> open_share(const select::MotorEvaluation& motor) {
  if (!motor.samples_needed) {
    return std::nullopt;
  }
  const select::OpenThreshold first = select::open_thresholds(motor, motor.games > 0).at(0);
  const bool is_of_demand = first.kind == select::kShareShort;
  return OpenShare{is_of_demand, first.share_ratio, is_of_demand ? *motor.short_interval : *motor.probability_interval,
                   first.threshold_ratio};
}

std::string words_of(const OpenShare& open, int samples) {
  return fmt::format("{:.0f} of {} samples {} (share {} %; the verdict changes at {:.0f} %)", open.share * samples, samples,
                     open.is_of_demand ? "miss the demand" : "exceed a limit", percent_range(open.interval), 100.0 * open.threshold_ratio);
}

std::string duration_text(double duration_s) {
  return duration_s < 120.0 ? fmt::format("{:.0f} s", duration_s) : fmt::format("{:.0f} min", duration_s / 60.0);
}

std::string slip_text(const duty::WheelDemand& wheel) {
  constexpr double kReported_share = 0.01;
  return wheel.slip_share < kReported_share
             ? ""
             : fmt::format("the plan needs more grip than the wheels have in {:.0f} % of the time", 100.0 * wheel.slip_share);
}

std::string why_infeasible(const select::MotorEvaluation& motor, const robot::Robot& robot) {
  if (motor.verdict != select::Verdict::infeasible) {
    return "";
  }
  const std::string what =
      motor.limiting_factor == select::LimitingFactor::voltage
          ? fmt::format("needs up to {:.1f} V when hot, {:.1f} V are available:", motor.highest_voltage_V, robot.available_V())
          : fmt::format("the driver's {:.1f} A are", robot.drive.current_limit_A.value());
  return fmt::format("{}: {} {:.0f} % of the demanded current at the worst moment, too little for {:.0f} % of the time\n", motor.motor_id,
                     what, 100.0 * motor.least_torque_share, 100.0 * motor.short_time_share);
}

}  // namespace heatsoak::present
