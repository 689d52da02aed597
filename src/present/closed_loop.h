// Adds the games of `evaluate --closed-loop` to the document of the evaluation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "present/document.h"
#include "robot/robot.h"
#include "simulate/closed_loop_rank.h"

namespace heatsoak::present {

/// Puts the verdicts of the driven games first and adds their table and notes to those of the evaluation.
void add_closed_loop(Document& document, const robot::Robot& robot, const std::vector<simulate::ClosedLoopRank>& ranks, int games,
                     std::uint64_t seed);

/// Adds a note if the robot has no sensors of the motor currents.
void add_missing_sensors(Document& document, const robot::Robot& robot);

/// Returns the consequence of the problem as a sentence, with the values of `score`.
std::string words_of(simulate::DriveProblem problem, const simulate::DriveScore& score);

}  // namespace heatsoak::present
