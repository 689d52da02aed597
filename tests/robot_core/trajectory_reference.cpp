#include "trajectory_reference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace robot_core::reference {
namespace {

double decades(std::mt19937_64& random, double low, double high) { return std::pow(10.0, uniform(random, low, high)); }

/// Returns a random state from which the velocity limits can be kept, before (-1) or after (+1) it is met.
State admissible(std::mt19937_64& random, const Limits& limits, double position, bool at_edges, double direction) {
  State state;
  state.position = position;
  const auto value = [&](double low, double high) {
    const int kind = at_edges ? static_cast<int>(random() % 8) : 7;
    return kind == 0 ? low : kind == 1 ? high : kind == 2 || kind == 3 ? 0.0 : uniform(random, low, high);
  };
  state.velocity = value(limits.velocity_min, limits.velocity_max);
  double highest = std::sqrt(2.0 * limits.jerk_max * (limits.velocity_max - state.velocity));
  double lowest = -std::sqrt(2.0 * limits.jerk_max * (state.velocity - limits.velocity_min));
  if (direction < 0.0) {
    std::swap(highest, lowest);
    highest = -highest;
    lowest = -lowest;
  }
  state.acceleration = at_edges ? std::clamp(value(limits.acceleration_min, limits.acceleration_max), lowest, highest)
                                : uniform(random, std::max(limits.acceleration_min, lowest), std::min(limits.acceleration_max, highest));
  return state;
}

}  // namespace

Task random_task(std::mt19937_64& random) {
  Task task;
  task.limits = {uniform(random, 0.1, 10), -uniform(random, 0.1, 10), uniform(random, 0.1, 10), -uniform(random, 0.1, 10),
                 uniform(random, 0.1, 10)};
  std::normal_distribution<double> normal(0.0, 4.0);
  task.start = admissible(random, task.limits, normal(random), false, 1.0);
  task.target = admissible(random, task.limits, normal(random), false, -1.0);
  return task;
}

Task extreme_task(std::mt19937_64& random) {
  Task task;
  task.limits = {decades(random, -2, 2), -decades(random, -2, 2), decades(random, -2, 2), -decades(random, -2, 2), decades(random, -2, 3)};
  if (random() % 2 == 0) {
    task.limits.velocity_min = -task.limits.velocity_max;
    task.limits.acceleration_min = -task.limits.acceleration_max;
  }
  const double reach = decades(random, -6, 4);
  task.start = admissible(random, task.limits, random() % 3 == 0 ? 0.0 : uniform(random, -reach, reach), true, 1.0);
  task.target = admissible(random, task.limits, random() % 3 == 0 ? 0.0 : uniform(random, -reach, reach), true, -1.0);
  return random() % 2 == 0 ? task : scaled(task, decades(random, -6, 6), decades(random, -6, 6));
}

Task violating_task(std::mt19937_64& random) {
  Task task = random_task(random);
  task.start.velocity = uniform(random, 3.0 * task.limits.velocity_min, 3.0 * task.limits.velocity_max);
  task.start.acceleration = uniform(random, 3.0 * task.limits.acceleration_min, 3.0 * task.limits.acceleration_max);
  return task;
}

Task mirrored(const Task& task) {
  const auto turned = [](const State& s) { return State{-s.position, -s.velocity, -s.acceleration}; };
  return {turned(task.start),
          turned(task.target),
          {-task.limits.velocity_min, -task.limits.velocity_max, -task.limits.acceleration_min, -task.limits.acceleration_max,
           task.limits.jerk_max}};
}

Task reversed(const Task& task) {
  const auto turned = [](const State& s) { return State{-s.position, s.velocity, -s.acceleration}; };
  return {turned(task.target),
          turned(task.start),
          {task.limits.velocity_max, task.limits.velocity_min, -task.limits.acceleration_min, -task.limits.acceleration_max,
           task.limits.jerk_max}};
}

Task scaled(const Task& task, double length, double time) {
  const double velocity = length / time;
  const double acceleration = velocity / time;
  const auto turned = [&](const State& s) { return State{s.position * length, s.velocity * velocity, s.acceleration * acceleration}; };
  return {turned(task.start),
          turned(task.target),
          {task.limits.velocity_max * velocity, task.limits.velocity_min * velocity, task.limits.acceleration_max * acceleration,
           task.limits.acceleration_min * acceleration, task.limits.jerk_max * acceleration / time}};
}

State scale_of(const Task& task, double duration_s) {
  const Limits& l = task.limits;
  const double acceleration = std::max({l.acceleration_max, -l.acceleration_min, std::abs(task.start.acceleration)});
  const double reached =
      std::min(acceleration, std::max(std::abs(task.start.acceleration), std::abs(task.target.acceleration)) + l.jerk_max * duration_s);
  const double velocity = std::min(std::max({l.velocity_max, -l.velocity_min, std::abs(task.start.velocity)}),
                                   std::max(std::abs(task.start.velocity), std::abs(task.target.velocity)) + reached * duration_s);
  return {std::max({std::abs(task.start.position), std::abs(task.target.position), velocity * duration_s}), velocity, reached};
}

Flaws flaws_of(const Motion& motion, const Task& task, double judged_from_s) {
  Flaws flaws;
  const State scale = scale_of(task, motion.duration_s);
  const auto difference = [&scale](const State& a, const State& b) {
    const auto relative = [](double error, double of) { return error == 0.0 ? 0.0 : std::abs(error) / of; };
    return std::max({relative(a.position - b.position, scale.position), relative(a.velocity - b.velocity, scale.velocity),
                     relative(a.acceleration - b.acceleration, scale.acceleration)});
  };
  const auto judge = [&](const State& s) {
    flaws.limit = std::max({flaws.limit, (s.velocity - task.limits.velocity_max) / task.limits.velocity_max,
                            (task.limits.velocity_min - s.velocity) / -task.limits.velocity_min,
                            (s.acceleration - task.limits.acceleration_max) / task.limits.acceleration_max,
                            (task.limits.acceleration_min - s.acceleration) / -task.limits.acceleration_min});
  };
  if (motion.segment_count > 0) {
    flaws.gap = difference(motion.segments[0].start, task.start);
    flaws.order = std::abs(motion.segments[0].start_s);
  } else {
    flaws.end = difference(task.start, task.target);
  }
  for (int i = 0; i < motion.segment_count; ++i) {
    const TrajectorySegment<double>& segment = motion.segments[i];
    const bool is_last = i + 1 == motion.segment_count;
    const double end_s = is_last ? motion.duration_s : motion.segments[i + 1].start_s;
    flaws.order = std::max(flaws.order, std::abs(segment.start_s + segment.duration_s - end_s) / motion.duration_s);
    flaws.jerk = std::max(flaws.jerk, std::abs(segment.jerk) / task.limits.jerk_max - 1.0);
    const State end = Motion::advanced(segment.start, segment.jerk, segment.duration_s);
    (is_last ? flaws.end : flaws.gap) =
        std::max(is_last ? flaws.end : flaws.gap, difference(end, is_last ? task.target : motion.segments[i + 1].start));
    if (segment.start_s >= judged_from_s) {
      judge(segment.start);
      judge(end);
      const double level_s = segment.jerk != 0.0 ? -segment.start.acceleration / segment.jerk : -1.0;
      if (level_s > 0.0 && level_s < segment.duration_s) {
        judge(Motion::advanced(segment.start, segment.jerk, level_s));
      }
    }
  }
  return flaws;
}

namespace {

struct Candidate {
  double duration_s;
  double distance;
  double peak_velocity;
};

/// Raises the acceleration to `peak`, holds it for `hold_s`, lowers it, holds it and raises it. The final velocity determines the rest;
/// `branch` chooses the sign of the lowest acceleration.
std::optional<Candidate> upward(const Task& task, double peak, double hold_s, double branch) {
  const Limits& l = task.limits;
  const double j = l.jerk_max;
  State s{0.0, task.start.velocity, task.start.acceleration};
  double time_s = 0.0;
  const auto go = [&](double jerk, double for_s) {
    s = Motion::advanced(s, jerk, for_s);
    time_s += for_s;
  };
  go(j, (peak - s.acceleration) / j);
  go(0.0, hold_s);
  const double a1 = task.target.acceleration;
  const double square = j * (s.velocity - task.target.velocity) + (peak * peak + a1 * a1) / 2.0;
  if (square < 0.0) {
    return {};
  }
  double lowest = branch * std::sqrt(square);
  double low_hold_s = 0.0;
  if (lowest < l.acceleration_min) {
    lowest = l.acceleration_min;
    low_hold_s = (task.target.velocity - s.velocity - (peak * peak + a1 * a1 - 2.0 * lowest * lowest) / (2.0 * j)) / lowest;
  }
  // For ends on the edge of the limits only one motion exists, which sampling meets within rounding.
  const double rounding = 1e-9 * (l.acceleration_max - l.acceleration_min);
  if (lowest > peak + rounding || lowest > a1 + rounding || low_hold_s < 0.0) {
    return {};
  }
  lowest = std::min({lowest, peak, a1});
  const double peak_velocity = lowest < 0.0 && peak > 0.0 ? s.velocity + peak * peak / (2.0 * j) : -std::numeric_limits<double>::max();
  go(-j, (peak - lowest) / j);
  go(0.0, low_hold_s);
  go(j, (a1 - lowest) / j);
  return Candidate{time_s, s.position, peak_velocity};
}

double earliest_upward(const Task& task, int samples) {
  const Limits& l = task.limits;
  const double distance = task.target.position - task.start.position;
  const double start_peak = task.start.acceleration;
  const double raise = l.acceleration_max - start_peak;
  const double longest_hold_s = (l.velocity_max - l.velocity_min) / l.acceleration_max;
  double best_s = std::numeric_limits<double>::infinity();
  // The parameter runs from 0 to 1 while the peak grows, then to 2 while it is held longer.
  const auto at = [&](double parameter, double branch) {
    return parameter <= 1.0 ? upward(task, start_peak + parameter * raise, 0.0, branch)
                            : upward(task, l.acceleration_max, (parameter - 1.0) * longest_hold_s, branch);
  };
  for (const double branch : {1.0, -1.0}) {
    const auto is_allowed = [&](const std::optional<Candidate>& c) { return c && c->peak_velocity <= l.velocity_max * (1.0 + 1e-12); };
    /// Returns the last allowed parameter between an allowed and another one.
    const auto edge = [&](double allowed, double other) {
      for (int i = 0; i < 60; ++i) {
        const double middle = (allowed + other) / 2.0;
        (is_allowed(at(middle, branch)) ? allowed : other) = middle;
      }
      return allowed;
    };
    const auto consider = [&](double from, double to) {
      const auto a = at(from, branch);
      const auto b = at(to, branch);
      if ((a->distance < distance) == (b->distance < distance)) {
        return;
      }
      double low = from;
      double high = to;
      const bool low_is_short = a->distance < distance;
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2.0;
        const auto c = at(middle, branch);
        if (!is_allowed(c)) {
          return;
        }
        ((c->distance < distance) == low_is_short ? low : high) = middle;
      }
      best_s = std::min(best_s, at(high, branch)->duration_s);
    };
    // At the velocity limit a cruise is possible.
    double slow = 0.0;
    double fast = 2.0;
    const auto velocity_at = [&](double parameter) {
      const double peak = parameter <= 1.0 ? start_peak + parameter * raise : l.acceleration_max;
      const double hold_s = std::max(parameter - 1.0, 0.0) * longest_hold_s;
      return task.start.velocity + (peak * peak - start_peak * start_peak) / (2.0 * l.jerk_max) + hold_s * peak +
             (peak > 0.0 ? peak * peak / (2.0 * l.jerk_max) : -1e300);
    };
    for (int i = 0; i < 100; ++i) {
      const double middle = (slow + fast) / 2.0;
      (velocity_at(middle) <= l.velocity_max ? slow : fast) = middle;
    }
    for (const double parameter : {slow, fast}) {
      const auto c = at(parameter, branch);
      if (is_allowed(c) && std::abs(c->peak_velocity - l.velocity_max) < 1e-9 * l.velocity_max && distance >= c->distance) {
        best_s = std::min(best_s, c->duration_s + (distance - c->distance) / l.velocity_max);
      }
    }
    std::vector<double> parameters;
    for (int i = 0; i <= samples; ++i) {
      const double u = static_cast<double>(i) / samples;
      parameters.push_back(u * u * (3.0 - 2.0 * u));  // denser at the ends
    }
    for (int i = 1; i <= samples; ++i) {
      parameters.push_back(1.0 + static_cast<double>(i) / samples);
    }
    for (std::size_t i = 1; i < parameters.size(); ++i) {
      double from = parameters[i - 1];
      double to = parameters[i];
      const bool from_is_allowed = is_allowed(at(from, branch));
      const bool to_is_allowed = is_allowed(at(to, branch));
      if (!from_is_allowed && !to_is_allowed) {
        continue;
      }
      if (!from_is_allowed) {
        from = edge(to, from);
      }
      if (!to_is_allowed) {
        to = edge(from, to);
      }
      consider(from, to);
    }
  }
  return best_s;
}

}  // namespace

double earliest_by_search(const Task& task, int samples) {
  return std::min(earliest_upward(task, samples), earliest_upward(mirrored(task), samples));
}

namespace {

/// Returns times that are dense near both ends, but never so close that differences are noise.
std::vector<double> graded_times(double duration_s, int grid) {
  std::vector<double> times;
  for (int i = 0; i <= grid; ++i) {
    times.push_back(duration_s * i / grid);
    const double near = duration_s * std::pow(10.0, -7.0 * i / grid) / 2.0;
    times.push_back(near);
    times.push_back(duration_s - near);
  }
  std::sort(times.begin(), times.end());
  const auto is_same = [duration_s](double a, double b) { return b - a < 1e-9 * duration_s; };
  times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
  times.back() = duration_s;
  return times;
}

/// Returns the lower convex hull of `values` at the same times.
std::vector<double> convex_hull(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (corners.size() >= 2) {
      const std::size_t a = corners[corners.size() - 2];
      const std::size_t b = corners.back();
      const double left = (values[b] - values[a]) * (times[i] - times[a]);
      const double right = (values[i] - values[a]) * (times[b] - times[a]);
      if (left < right) {
        break;
      }
      corners.pop_back();
    }
    corners.push_back(i);
  }
  std::vector<double> hull(values.size());
  for (std::size_t k = 1; k < corners.size(); ++k) {
    for (std::size_t i = corners[k - 1]; i <= corners[k]; ++i) {
      const double share = (times[i] - times[corners[k - 1]]) / (times[corners[k]] - times[corners[k - 1]]);
      hull[i] = values[corners[k - 1]] + share * (values[corners[k]] - values[corners[k - 1]]);
    }
  }
  return hull;
}

/// Returns an upper bound of the velocity of a motion of that duration, because v + jerk t^2 / 2 is convex.
std::vector<double> velocity_bound(const Task& task, const std::vector<double>& times) {
  const Limits& l = task.limits;
  const auto raised = [&](double v, double a, double a_max, double t) {
    const double raise_s = std::min(t, (a_max - a) / l.jerk_max);
    return v + raise_s * (a + l.jerk_max * raise_s / 2.0) + (t - raise_s) * a_max;
  };
  std::vector<double> values;
  for (const double t : times) {
    const double bound =
        std::min({raised(task.start.velocity, task.start.acceleration, l.acceleration_max, t),
                  raised(task.target.velocity, -task.target.acceleration, -l.acceleration_min, times.back() - t), l.velocity_max});
    values.push_back(bound + l.jerk_max * t * t / 2.0);
  }
  std::vector<double> hull = convex_hull(times, values);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    hull[i] -= l.jerk_max * times[i] * times[i] / 2.0;
  }
  return hull;
}

double distance_bound(const std::vector<double>& times, const std::vector<double>& velocity, const Limits& l) {
  double sum = 0.0;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    // Between the points v + jerk t^2 / 2 is below its chord, and v exceeds its own chord by no more than the slopes allow.
    const double step_s = times[i] - times[i - 1];
    const double bulge = std::min(l.jerk_max * step_s / 12.0, (l.acceleration_max - l.acceleration_min) / 8.0) * step_s * step_s;
    sum += std::min(step_s * (velocity[i - 1] + velocity[i]) / 2.0 + bulge, step_s * l.velocity_max);
  }
  return sum;
}

}  // namespace

bool is_impossible(const Task& task, double duration_s, int grid) {
  const std::vector<double> times = graded_times(duration_s, grid);
  const std::vector<double> above = velocity_bound(task, times);
  const std::vector<double> below = velocity_bound(mirrored(task), times);
  const State scale = scale_of(task, duration_s);
  const double rounding = 1e-13;
  for (std::size_t i = 0; i < above.size(); ++i) {
    if (above[i] < -below[i] - rounding * (scale.velocity + task.limits.jerk_max * duration_s * duration_s)) {
      return true;
    }
  }
  const double distance = task.target.position - task.start.position;
  const double room = rounding * (scale.position + task.limits.jerk_max * duration_s * duration_s * duration_s);
  return distance > distance_bound(times, above, task.limits) + room ||
         -distance > distance_bound(times, below, mirrored(task).limits) + room;
}

}  // namespace robot_core::reference
