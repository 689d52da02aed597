// Assumed friction for a robot whose file states none, so that a match can be simulated before any measurement.
#pragma once

#include "robot/robot.h"

namespace heatsoak::robot {

/// Returns whether the file states any value of [friction] or [friction.heading]; false for assumed friction.
bool has_friction(const Robot& robot);

/// Returns the robot itself if has_friction(). Otherwise returns a copy with assumed values and `is_friction_assumed`: estimates with
/// ranges, which draw_sample() samples like those of a file. Source: the friction that TIGERs Mannheim (2020) and RoboTeam Twente (2024)
/// measured on their robots, scaled by weight and wheel radius; the ranges include both. The friction feed-forward of the drive core stays
/// off.
Robot with_assumed_friction(Robot robot);

}  // namespace heatsoak::robot
