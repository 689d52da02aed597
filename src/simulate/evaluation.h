// The answer of `evaluate`: motors ranked on one duty of one robot, by samples and, on request, by games in the closed loop.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "select/changes.h"
#include "select/evaluate.h"
#include "simulate/closed_loop_rank.h"

namespace heatsoak::simulate {

/// Games that the drive core drives with each motor.
struct ClosedLoopJob {
  int games = 3;
  GuardUse guard = GuardUse::shadow;
};

struct EvaluationJob {
  robot::Robot robot;
  duty::Duty duty;
  std::vector<motor::Motor> motors;                    ///< at least one, with different ids
  std::map<std::string, std::string> conditions = {};  ///< conditions under which the motors were read
  std::uint64_t seed = 1;                              ///< seed of the samples and of the first game
  std::optional<int> samples = {};  ///< nothing: first_samples(), and up to most_samples() until the verdicts are decided
  int threads = 0;                  ///< 0: all cores; the result does not depend on it
  bool with_bands = false;          ///< keep the range of the samples over time
  bool suggests = false;            ///< search for changes of the robot also if its motor passes
  /// Returns the motors that may replace the robot's; called only if changes are searched for. May be empty.
  std::function<std::vector<motor::Motor>()> database = {};
  std::optional<ClosedLoopJob> closed_loop = {};
};

/// Changes of the robot that cool one of the motors.
struct SuggestedChanges {
  std::string motor_id;
  std::vector<select::ChangeEffect> effects;
};

struct EvaluationAnswer {
  robot::Robot robot;  ///< on a match with assumed friction if its file has none
  duty::Duty duty;
  std::vector<motor::Motor> motors;
  std::map<std::string, std::string> conditions;
  std::uint64_t seed = 1;
  int samples = 0;             ///< samples of the first round
  duty::WheelDemand demand;    ///< nominal demand of one of the wheels
  std::size_t draw_count = 0;  ///< number of simulated games; 0 for a duty without random samples
  std::vector<select::MotorEvaluation>
      results;  ///< with nominal curves; in the order of `ranks` in a closed loop, else as evaluate() sorts them
  std::optional<ClosedLoopJob> closed_loop;
  std::vector<ClosedLoopRank> ranks;  ///< one for each result; empty without a closed loop
  /// For the motor that the robot is built with if it is among the results, else for the best one. Nothing if that motor passes and no
  /// changes were requested.
  std::optional<SuggestedChanges> changes;

  /// Returns the worst verdict of all motors, that of the games in a closed loop.
  [[nodiscard]] select::Verdict worst_verdict() const;
};

/// Throws Failure (bad_input) if more samples are requested than possible, or a closed loop for a duty that is not a match.
EvaluationAnswer run_evaluation(const EvaluationJob& job, const base::ProgressFor& progress = {});

}  // namespace heatsoak::simulate
