// Phrases that several commands share.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "present/document.h"
#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak::present {

/// Verdict as it is displayed. Without samples it is only that of the nominal motor in one run, and has other names than a verdict.
enum class ShownVerdict { pass, undecided, marginal, fail, infeasible, nominal_within, nominal_over, nominal_short };
ShownVerdict shown_verdict(const select::MotorEvaluation& motor);
/// Returns "pass", "undecided", …, and without samples "within", "over", "short". The JSON output has
/// select::stated_verdict() in place of "undecided" and of the last three.
std::string_view to_string(ShownVerdict verdict);
/// Returns the colour of a verdict.
Tone tone_of(ShownVerdict verdict);
Tone tone_of(select::Verdict verdict);

/// Formats "1 of 1 motor passes", "2 of 3 motors pass".
std::string passing_text(std::ptrdiff_t passing, std::size_t all, std::string_view what);

/// Returns the id of the duty, with the remark that mass and wheels of the robot do not matter if the duty states torque and speed itself.
std::string load_words(const duty::Duty& duty);

/// Formats a range of shares in percent, rounded outwards: "0…3".
std::string percent_range(const select::Interval95& range);

/// Share of samples that leaves the verdict undecided: its interval contains a threshold.
struct OpenShare {
  bool is_of_demand = false;  ///< samples that miss the demand; else samples over a temperature limit
  double share = 0.0;
  select::Interval95 interval;
  double threshold_ratio = 0.0;
};
/// Returns nothing if the verdict is decided.
std::optional<OpenShare> open_share(const select::MotorEvaluation& motor);
/// Formats "18 of 600 samples exceed a limit (share 1…11 %; the verdict changes at 5 %)".
std::string words_of(const OpenShare& open, int samples);

/// Formats a duration: "58 s", "12 min".
std::string duration_text(double duration_s);

/// States in which share of the time the plan needs more grip than the wheels have, as part of a sentence; empty if nearly never.
std::string slip_text(const duty::WheelDemand& wheel);

/// Returns a line that explains why a motor cannot deliver the demand; empty if it can.
std::string why_infeasible(const select::MotorEvaluation& motor, const robot::Robot& robot);

}  // namespace heatsoak::present
