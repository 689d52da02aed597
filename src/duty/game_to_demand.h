// A recorded game to what the wheels of a robot had to do.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "duty/demand.h"
#include "robot/inverse_dynamics.h"

namespace heatsoak::duty {

struct GameDemand {
  std::string player;                  ///< "yellow 3"
  std::vector<WheelDemand> wheels;     ///< empty where no robot was followed long enough
  std::vector<std::string> sentences;  ///< quality of the log, bandwidth of the smoothing, share of untransmittable demand
};

/// Every moment of it in turn, and how long it lasts.
using GameObserver = std::function<void(double duration_s, const robot::WheelDemands& wheels)>;

/// `player` empty: the robot with the largest ∫a². Motion is smoothed, evaluated at 1 kHz and put through the inverse dynamics;
/// where the robot was not seen the wheels stand. Throws Failure (bad_input) for an unreadable log or an unknown player.
GameDemand demand_of_game(const std::filesystem::path& log, const std::string& player, const robot::Robot& robot, double bin_s = kBin_s,
                          const GameObserver& observer = {});

}  // namespace heatsoak::duty
