// Document and JSON of `evaluate`.
#pragma once

#include <string>
#include <vector>

#include "present/document.h"
#include "present/json.h"
#include "report/chart.h"
#include "select/evaluate.h"
#include "simulate/evaluation.h"

namespace heatsoak::present {

Document evaluation_document(const simulate::EvaluationAnswer& answer);
Json evaluation_json(const simulate::EvaluationAnswer& answer);
/// Returns the picture of the sampled load, also if the answer contains games in a closed loop.
report::Chart evaluation_chart(const simulate::EvaluationAnswer& answer);

/// Returns the winding temperature over time as eight block characters, scaled from ambient (lowest) to the winding limit (highest). Each
/// shows the maximum of an eighth of the time. Empty without curves.
std::string sparkline(const select::MotorEvaluation& motor, double ambient_C);

/// Adds a note for each line of `text`.
void add_lines(std::vector<Note>& notes, std::string_view text, Severity severity);

}  // namespace heatsoak::present
