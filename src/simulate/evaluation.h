// Answer of `evaluate`: ranks motors on one duty of one robot, by samples and, on request, by games in closed loop.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/job_progress.h"
#include "select/changes.h"
#include "select/evaluate.h"
#include "select/rest.h"
#include "simulate/closed_loop_rank.h"

namespace heatsoak::simulate {

/// Number and guard mode of the games that the drive core drives with each motor.
struct ClosedLoopJob {
  int games = 3;
  GuardUse guard = GuardUse::shadow;
};

struct EvaluationJob {
  robot::Robot robot;
  duty::Duty duty;
  std::vector<motor::Motor> motors;                    ///< at least one, with different ids
  std::map<std::string, std::string> conditions = {};  ///< conditions under which the motors were read
  std::uint64_t seed = 1;                              ///< seed of the samples; games in closed loop use consecutive seeds from it
  std::optional<int> samples = {};                     ///< empty: first_samples(), then up to most_samples() until the verdicts are decided
  int threads = 0;                                     ///< 0: all cores; the result does not depend on it
  bool with_bands = false;                             ///< keep the range of the samples over time
  bool with_changes = true;                            ///< search for changes of the robot that cool its motor
  bool with_changes_if_passing = true;                 ///< search for them also if that motor passes, when the headline names none
  bool has_chosen_motors = false;                      ///< the user chose `motors`: another one is suggested only if none of them passes
  /// Returns the motors that may replace the robot's; called only if one of them may be suggested. May be empty.
  std::function<std::vector<motor::Motor>()> database = {};
  std::optional<ClosedLoopJob> closed_loop = {};
};

/// Changes of the robot that cool one of the motors. Another motor is among them only if that one does not pass.
struct SuggestedChanges {
  std::string motor_id;
  bool passes = false;  ///< the motor passes without a change
  std::vector<select::ChangeEffect> effects;
};

struct EvaluationAnswer {
  robot::Robot robot;  ///< robot; on a match with assumed friction if its file has none
  duty::Duty duty;
  std::vector<motor::Motor> motors;
  std::map<std::string, std::string> conditions;
  std::uint64_t seed = 1;
  int samples = 0;                               ///< samples of the first round
  duty::WheelDemand demand;                      ///< nominal demand of one of the wheels
  std::size_t draw_count = 0;                    ///< number of simulated games; 0 for a duty without random samples
  std::vector<select::MotorEvaluation> results;  ///< with nominal curves; sorted like `ranks` in closed loop, else by evaluate()
  /// Rests of hot motors by id, without motors that cannot drive the duty or whose limits no current reaches.
  std::map<std::string, std::vector<select::RestOfHotMotor>> rests;
  std::optional<ClosedLoopJob> closed_loop;
  std::vector<ClosedLoopRank> ranks;  ///< one for each result; empty without a closed loop
  /// Changes for the robot's own motor if it is among the results, else for the best motor. Empty if the job is without changes.
  std::optional<SuggestedChanges> changes;

  /// Returns the worst verdict that the samples of any motor still allow; in closed loop the worst of the games.
  [[nodiscard]] select::Verdict worst_verdict() const;
};

/// Runs the evaluation. Throws Failure (bad_input) if too many samples are requested, or a closed loop for a duty that is not a match.
EvaluationAnswer run_evaluation(const EvaluationJob& job, const base::JobProgress& progress = {});

}  // namespace heatsoak::simulate
