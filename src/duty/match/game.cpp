#include "duty/match/game.h"

#include <algorithm>
#include <cmath>

namespace heatsoak {
namespace {

constexpr double kHalf_s = 300.0;
constexpr double kHalfTime_s = 300.0;
constexpr double kOvertimeHalf_s = 150.0;
constexpr double kBeforeOvertime_s = 300.0;
constexpr double kOvertimeBreak_s = 120.0;
constexpr double kTimeoutBudget_s = 300.0;
constexpr double kLongestPlacement_s = 30.0;
constexpr double kShortestStop_s = 2.0;

double exponential(double mean, Random& random) { return -mean * std::log(random.uniform()); }

class Game {
 public:
  Game(Division division, const MatchValues& values, Random& random)
      : free_kick_s_(division == Division::a ? 5.0 : 10.0), values_(values), random_(random) {}

  void half(double length_s) {
    double left_s = length_s;
    // The rules give ten seconds for a kick-off once it is called.
    add(Phase::kick_off_preparation, 5.0 + 5.0 * random_.uniform());
    while (left_s > 0.0) {
      const double play_s = std::min(left_s, exponential(values_.running_mean_s, random_));
      add(Phase::running, play_s);
      left_s -= play_s;
      if (left_s > 0.0) {
        interruption(length_s, left_s);
      }
    }
  }
  void rest(double length_s) { add(Phase::half_time, length_s); }
  std::vector<MatchPhase> spans() { return std::move(spans_); }

 private:
  void add(Phase phase, double duration_s) { spans_.push_back({phase, duration_s}); }

  void interruption(double half_s, double& left_s) {
    const double interruptions_per_half = half_s / values_.running_mean_s;
    if (random_.uniform() < values_.halt_count / interruptions_per_half) {
      add(Phase::halt, exponential(values_.halt_mean_s, random_));
    }
    add(Phase::stop, kShortestStop_s + exponential(values_.stop_mean_s, random_));
    if (random_.uniform() < values_.timeout_count / (2.0 * interruptions_per_half) && timeout_left_s_ > 0.0) {
      const double length_s = std::min(timeout_left_s_, kTimeoutBudget_s / 4.0 * (0.5 + random_.uniform()));
      timeout_left_s_ -= length_s;
      add(Phase::timeout, length_s);
      add(Phase::stop, kShortestStop_s + exponential(values_.stop_mean_s, random_));
    }
    if (random_.uniform() < values_.placement_share) {
      add(Phase::ball_placement, std::min(kLongestPlacement_s, exponential(values_.placement_mean_s, random_)));
    }
    const double wait_s = std::min(left_s, free_kick_s_ * random_.uniform());
    add(Phase::free_kick, wait_s);
    left_s -= wait_s;
  }

  double free_kick_s_;
  const MatchValues& values_;
  Random& random_;
  double timeout_left_s_ = 2.0 * kTimeoutBudget_s;
  std::vector<MatchPhase> spans_;
};

}  // namespace

PhaseRule rule_of(Phase phase) {
  switch (phase) {
    case Phase::running:
    case Phase::free_kick:
      return {.clock_runs = true};
    case Phase::stop:
      return {.clock_runs = false, .speed_limit_m_per_s = 1.5, .settle_s = 2.0};
    case Phase::halt:
      return {.clock_runs = false, .speed_limit_m_per_s = 0.0, .settle_s = 2.0};
    case Phase::kick_off_preparation:
    case Phase::ball_placement:
    case Phase::timeout:
    case Phase::half_time:
      return {};
  }
  return {};
}

FieldSize field_of(Division division) { return division == Division::a ? FieldSize{12.0, 9.0} : FieldSize{9.0, 6.0}; }

std::vector<MatchPhase> generate_game(Division division, bool overtime, const MatchValues& values, Random& random) {
  Game game(division, values, random);
  game.half(kHalf_s);
  game.rest(kHalfTime_s);
  game.half(kHalf_s);
  if (overtime) {
    game.rest(kBeforeOvertime_s);
    game.half(kOvertimeHalf_s);
    game.rest(kOvertimeBreak_s);
    game.half(kOvertimeHalf_s);
  }
  return game.spans();
}

}  // namespace heatsoak
