// Adds the games of `evaluate --closed-loop` to the document of the evaluation.
#pragma once

#include <string>

#include "present/document.h"
#include "robot/robot.h"
#include "simulate/evaluation.h"

namespace heatsoak::present {

/// Adds the verdicts of the driven games to the headline, puts their table first, and adds their notes. Requires answer.closed_loop.
void add_closed_loop(Document& document, const simulate::EvaluationAnswer& answer);

/// Adds a note if the robot has no sensors of the motor currents.
void add_missing_sensors(Document& document, const robot::Robot& robot);

/// Returns why a motor was not driven as part of a sentence; empty if it was driven.
std::string why_not_driven(const simulate::GameDrives& drives);

/// Returns the consequence of the problem as a sentence, with the values of `score`.
std::string words_of(simulate::DriveProblem problem, const simulate::DriveScore& score);

}  // namespace heatsoak::present
