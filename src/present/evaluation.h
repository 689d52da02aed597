// Formats the answer of `evaluate` as a document.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "duty/duty.h"
#include "present/document.h"
#include "robot/robot.h"
#include "select/changes.h"
#include "select/evaluate.h"

namespace heatsoak::present {

/// Inputs of an evaluation that its results do not contain.
struct EvaluationContext {
  const Robot& robot;
  const Duty& duty;
  const WheelDemand& demand;  ///< nominal demand of one of the wheels
  std::uint64_t seed = 1;
  std::size_t draws = 0;  ///< number of simulated games; 0 for a duty without random samples
};

/// `results` are sorted as evaluate() returns them and contain their nominal curves.
Document evaluation_document(std::span<const MotorEvaluation> results, const EvaluationContext& context);

/// Adds a table of the changes that cool the winding of `motor_id` most, three at most.
void add_changes(Document& document, std::span<const ChangeEffect> effects, const std::string& motor_id);

/// Returns the winding temperature over time as eight block characters, scaled from ambient (lowest) to the winding limit (highest). Each
/// shows the maximum of an eighth of the time. Empty without curves.
std::string sparkline(const MotorEvaluation& motor, double ambient_C);

/// Returns the verdict, or "undecided" if more samples could decide it. The JSON output then keeps the more cautious verdict.
std::string_view verdict_word(const MotorEvaluation& motor);

/// Returns the tone (colour) of a verdict.
Tone tone_of(Verdict verdict);

/// Adds a note for each line of `text`.
void add_lines(std::vector<Note>& notes, std::string_view text, Severity severity);

}  // namespace heatsoak::present
