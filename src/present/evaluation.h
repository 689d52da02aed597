// The answer of `evaluate` as a document.
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

/// What an evaluation was made from, beside its results.
struct EvaluationContext {
  const Robot& robot;
  const Duty& duty;
  const WheelDemand& demand;  ///< nominal, of any wheel
  std::uint64_t seed = 1;
  std::size_t draws = 0;  ///< games that were played; 0 for a duty without draws
};

/// `results` are sorted as by evaluate() and have their nominal curves.
Document evaluation_document(std::span<const MotorEvaluation> results, const EvaluationContext& context);

/// Adds a table of the changes that lower the winding of `motor_id` most, three at most.
void add_changes(Document& document, std::span<const ChangeEffect> effects, const std::string& motor_id);

/// The winding over time as eight block characters, from the ambient temperature at the lowest to the winding's limit at the highest;
/// each shows the highest temperature of an eighth of the time. Empty without curves.
std::string sparkline(const MotorEvaluation& motor, double ambient_C);

/// The verdict, or "undecided" where more samples could tell: the JSON keeps the cautious one of both verdicts then.
std::string_view verdict_word(const MotorEvaluation& motor);

/// The colour of a verdict.
Tone tone_of(Verdict verdict);

/// A note for each line of `text`.
void add_lines(std::vector<Note>& notes, std::string_view text, Severity severity);

}  // namespace heatsoak::present
