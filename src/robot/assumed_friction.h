// The friction of a robot whose file does not state any, so that a match can be simulated before anything has been measured.
#pragma once

#include <string>

#include "robot/robot.h"

namespace heatsoak {

/// Whether the file states any figure of [friction] or [friction.heading]; false for assumed friction.
bool has_friction(const Robot& robot);

/// The robot itself if it has_friction(). Otherwise a copy with assumed figures and `is_friction_assumed`: estimates with ranges, which
/// draw_sample() draws like those of a file. Origin: the friction that TIGERs Mannheim (2020) and RoboTeam Twente (2024) measured on their
/// robots, per weight and wheel radius; the ranges include both. The drive core's feed-forward stays off.
Robot with_assumed_friction(Robot robot);

/// What was assumed, as a line for the user; empty where nothing was.
std::string assumed_friction_text(const Robot& robot);

}  // namespace heatsoak
