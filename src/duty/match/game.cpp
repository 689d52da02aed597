#include "duty/match/game.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::duty {
namespace {

constexpr double kHalf_s = 300.0;
constexpr double kHalfTime_s = 300.0;
constexpr double kOvertimeHalf_s = 150.0;
constexpr double kBeforeOvertime_s = 300.0;
constexpr double kOvertimeBreak_s = 120.0;
constexpr double kTimeoutBudget_s = 300.0;
constexpr int kTimeouts = 8;  // number of timeouts of both teams in two halves
constexpr double kLongestPlacement_s = 30.0;

double exponential(double mean, base::Random& random) { return -mean * std::log(random.uniform()); }

/// Draws a number of events from a Poisson distribution.
int poisson(double mean, base::Random& random) {
  int count = 0;
  for (double left = mean + std::log(random.uniform()); left > 0.0; left += std::log(random.uniform())) {
    ++count;
  }
  return count;
}

/// Returns the mean of the exponential distribution that has the mean `mean_s` after clipping at `longest_s`.
double mean_before_the_cut(double mean_s, double longest_s) {
  const auto when_cut_s = [longest_s](double uncut_s) { return -uncut_s * std::expm1(-longest_s / uncut_s); };
  double low_s = mean_s;
  double high_s = 2.0 * mean_s;
  while (when_cut_s(high_s) < mean_s) {
    high_s *= 2.0;
  }
  for (int i = 0; i < 50; ++i) {
    const double middle_s = 0.5 * (low_s + high_s);
    (when_cut_s(middle_s) < mean_s ? low_s : high_s) = middle_s;
  }
  return high_s;
}

class Game {
 public:
  Game(Division division, const MatchValues& values, base::Random& random)
      : free_kick_s_(division == Division::a ? 5.0 : 10.0),
        placement_mean_s_(mean_before_the_cut(values.placement_mean_s, kLongestPlacement_s)),
        values_(values),
        random_(random) {}

  void half(double length_s) {
    std::vector<Interruption> half = segments(length_s);
    hand_out(half, length_s / kHalf_s);
    // The rules allow ten seconds for a kick-off after the command.
    add(Phase::kick_off_preparation, 5.0 + 5.0 * random_.uniform());
    for (const Interruption& each : half) {
      add(Phase::running, each.play_before_s);
      for (int i = 0; i < each.halts; ++i) {
        add(Phase::halt, exponential(values_.halt_mean_s, random_));
      }
      if (!each.ends_the_half) {
        stop();
      }
      for (int i = 0; i < each.timeouts; ++i) {
        timeout();
      }
      if (each.ends_the_half) {
        return;
      }
      if (random_.uniform() < values_.placement_share) {
        add(Phase::ball_placement, std::min(kLongestPlacement_s, exponential(placement_mean_s_, random_)));
      }
      add(Phase::free_kick, each.free_kick_after_s);
    }
  }
  void rest(double length_s) { add(Phase::half_time, length_s); }
  /// Resets the time for timeouts: overtime has half as many, of half the total duration.
  void begin_overtime() { timeout_left_s_ = kTimeoutBudget_s; }
  std::vector<MatchPhase> spans() { return std::move(spans_); }

 private:
  struct Interruption {
    double play_before_s = 0.0;
    double free_kick_after_s = 0.0;
    bool ends_the_half = false;
    int halts = 0;
    int timeouts = 0;
  };

  void add(Phase phase, double duration_s) { spans_.push_back({phase, duration_s}); }

  /// Returns the interruptions of one half with `left_s` on the clock. Only a free kick can follow its last segment of play.
  std::vector<Interruption> segments(double left_s) {
    std::vector<Interruption> half;
    while (left_s > 0.0) {
      Interruption& each = half.emplace_back();
      each.play_before_s = std::min(left_s, exponential(values_.running_mean_s, random_));
      left_s -= each.play_before_s;
      each.ends_the_half = !(left_s > 0.0);
      each.free_kick_after_s = std::min(left_s, free_kick_s_ * random_.uniform());
      left_s -= each.free_kick_after_s;
    }
    return half;
  }

  /// Draws the numbers of halts and timeouts first and then their places, so that the means do not depend on the number of interruptions.
  void hand_out(std::vector<Interruption>& half, double halves) {
    const std::size_t places = half.size() - (half.back().ends_the_half && half.size() > 1 ? 1 : 0);
    const auto anywhere = [&]() -> Interruption& {
      return half[static_cast<std::size_t>(static_cast<double>(places) * random_.uniform())];
    };
    for (int left = poisson(values_.halt_count * halves, random_); left > 0; --left) {
      ++anywhere().halts;
    }
    const int most = static_cast<int>(std::lround(0.5 * kTimeouts * halves));
    for (int i = 0; i < most; ++i) {
      anywhere().timeouts += random_.uniform() < values_.timeout_count / kTimeouts ? 1 : 0;
    }
  }

  void stop() {
    const double shortest_s = std::min(values_.stop_shortest_s, values_.stop_mean_s);
    add(Phase::stop, shortest_s + exponential(values_.stop_mean_s - shortest_s, random_));
  }

  void timeout() {
    const double length_s = std::min(timeout_left_s_, kTimeoutBudget_s / 4.0 * (0.5 + random_.uniform()));
    if (length_s > 0.0) {
      timeout_left_s_ -= length_s;
      add(Phase::timeout, length_s);
      stop();
    }
  }

  double free_kick_s_;
  double placement_mean_s_;
  const MatchValues& values_;
  base::Random& random_;
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

std::vector<MatchPhase> generate_game(Division division, bool overtime, const MatchValues& values, base::Random& random) {
  Game game(division, values, random);
  game.half(kHalf_s);
  game.rest(kHalfTime_s);
  game.half(kHalf_s);
  if (overtime) {
    game.rest(kBeforeOvertime_s);
    game.begin_overtime();
    game.half(kOvertimeHalf_s);
    game.rest(kOvertimeBreak_s);
    game.half(kOvertimeHalf_s);
  }
  return game.spans();
}

}  // namespace heatsoak::duty
