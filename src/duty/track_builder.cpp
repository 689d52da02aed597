#include "duty/track_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace heatsoak::duty {
namespace {

constexpr int kLargestRobotId = 255;
constexpr double kFarthest_m = 20.0;      // the largest field is 13.4 m with its border
constexpr double kMergeWindow_s = 0.012;  // cameras are not synchronous; frames come every 10 to 17 ms
constexpr double kShortestStep_s = 0.001;
constexpr double kSameRobot_m = 0.15;    // less than a robot's width: closer detections of one id are the same robot
constexpr double kCameraHeight_m = 3.0;  // beyond this distance the angle of view is flat, and the weight decreases
constexpr double kLeastConfidence = 1e-3;
constexpr double kNoise_m = 0.05;         // largest noise of a camera
constexpr double kFastest_m_per_s = 8.0;  // the fastest robots of the league run 4 to 5 m/s
constexpr double kNoise_rad = 0.7;
constexpr double kFastest_rad_per_s = 30.0;
constexpr std::size_t kTeleportConfirmed = 5;  // number of consecutive points elsewhere that confirm a moved robot
constexpr double kSeamFade_s = 2.0;
constexpr double kOffsetMemory = 0.1;
constexpr double kLeastTrust = 0.02;
constexpr double kRateMemory = 0.3;
constexpr double kMissingFrames = 3.5;  // in usual steps: three frames are missing
constexpr double kShortestSegment_s = 1.0;
constexpr std::size_t kFewestPoints = 10;
constexpr double kSummaryBin_s = 0.1;
constexpr std::size_t kMostSights = 16;
constexpr std::size_t kMostPhases = 100'000;
constexpr std::size_t kMostProblems = 20;

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

bool within_reach(const TrackPoint& from, const TrackPoint& to, double expected_yaw_rad) {
  const double step_s = to.time_s - from.time_s;
  const double turn_rad = std::abs(wrapped(to.yaw_rad - expected_yaw_rad));
  return std::hypot(to.x_m - from.x_m, to.y_m - from.y_m) <= kNoise_m + kFastest_m_per_s * step_s &&
         turn_rad <= kNoise_rad + kFastest_rad_per_s * step_s;
}

double weight(const Detection& sight) {
  const double slope = sight.camera_distance_m.value_or(0.0) / kCameraHeight_m;
  return std::max(sight.confidence, kLeastConfidence) / (1.0 + slope * slope);
}

}  // namespace

bool TrackBuilder::is_plausible(const Detection& d) {
  return std::isfinite(d.time_s) && std::isfinite(d.x_m) && std::isfinite(d.y_m) && std::isfinite(d.yaw_rad) &&
         std::isfinite(d.confidence) && std::isfinite(d.camera_distance_m.value_or(0.0)) && std::abs(d.x_m) <= kFarthest_m &&
         std::abs(d.y_m) <= kFarthest_m && std::abs(d.yaw_rad) < 1e4 && d.robot.id >= 0 && d.robot.id <= kLargestRobotId;
}

void TrackBuilder::see(const Detection& detection) {
  ++report().detections;
  if (!is_plausible(detection)) {
    ++report().implausible;
    return;
  }
  latest_s_ = std::max(latest_s_.value_or(detection.time_s), detection.time_s);
  if (detection.time_s < options_.from_s || detection.time_s > options_.until_s) {
    return;
  }
  first_s_ = std::min(first_s_.value_or(detection.time_s), detection.time_s);
  Robot& robot = robots_[detection.robot];
  robot.track.robot = robot.summary.robot = detection.robot;
  if (!robot.frame.empty()) {
    const Detection& first = robot.frame.front();
    if (detection.time_s < first.time_s - kMergeWindow_s) {
      ++report().out_of_order;
      return;
    }
    const auto same = std::ranges::find(robot.frame, detection.camera, &Detection::camera);
    const bool is_next_frame = same != robot.frame.end() && std::abs(detection.time_s - same->time_s) > kShortestStep_s;
    if (is_next_frame || detection.time_s - first.time_s > kMergeWindow_s) {
      close_frame(robot);
    }
  }
  if (robot.frame.size() < kMostSights) {
    robot.frame.push_back(detection);
  }
}

TrackBuilder::Pose TrackBuilder::expected(const Robot& robot, double time_s) {
  const double step_s = time_s - robot.last->time_s;
  return {robot.last->x_m + robot.rate.x_m * step_s, robot.last->y_m + robot.rate.y_m * step_s,
          robot.last->yaw_rad + robot.rate.yaw_rad * step_s};
}

/// Keeps one detection of each camera, and only those that agree with the best one. The best is nearest to the expected position or,
/// without one, has the largest weight.
void TrackBuilder::choose_sights(Robot& robot) {
  if (robot.frame.size() < 2) {
    return;
  }
  const auto badness = [&](const Detection& sight) {
    if (!robot.last || sight.time_s - robot.last->time_s > kLongestBridge_s) {
      return -weight(sight);
    }
    const Pose there = expected(robot, sight.time_s);
    return std::hypot(sight.x_m - there.x_m, sight.y_m - there.y_m);
  };
  std::ranges::stable_sort(robot.frame, {}, badness);
  std::vector<Detection> chosen;
  for (const Detection& sight : robot.frame) {
    if (std::ranges::find(chosen, sight.camera, &Detection::camera) != chosen.end()) {
      ++report().doubled;
    } else if (!chosen.empty() && std::hypot(sight.x_m - chosen.front().x_m, sight.y_m - chosen.front().y_m) > kSameRobot_m) {
      ++report().outliers;
    } else {
      chosen.push_back(sight);
    }
  }
  report().merged += chosen.size() - 1;
  robot.frame = std::move(chosen);
}

/// Lets the offsets decay, so that the position converges to the average of the cameras.
void TrackBuilder::forget_offsets(Robot& robot, double now_s) {
  if (!robot.last || now_s - robot.last->time_s > kLongestBridge_s) {
    robot.offsets.clear();
    return;
  }
  std::erase_if(robot.offsets, [&](const CameraOffset& each) { return now_s - each.seen_s > kLongestBridge_s; });
  const double kept = std::exp(-std::max(0.0, now_s - robot.last->time_s) / kSeamFade_s);
  for (CameraOffset& each : robot.offsets) {
    each.offset = {each.offset.x_m * kept, each.offset.y_m * kept, each.offset.yaw_rad * kept};
  }
}

/// Returns the offset of a camera. A new camera starts with its present difference, because a step of 1 cm would look like an acceleration.
TrackBuilder::CameraOffset& TrackBuilder::offset_of(Robot& robot, const Detection& sight, const TrackPoint& reference) {
  const auto known = std::ranges::find(robot.offsets, sight.camera, &CameraOffset::camera);
  if (known != robot.offsets.end()) {
    known->seen_s = sight.time_s;
    return *known;
  }
  Pose step{sight.x_m - reference.x_m, sight.y_m - reference.y_m, wrapped(sight.yaw_rad - reference.yaw_rad)};
  if (!robot.last || std::hypot(step.x_m, step.y_m) > kSameRobot_m || std::abs(step.yaw_rad) > kNoise_rad) {
    step = {};
  }
  robot.offsets.push_back({sight.camera, step, robot.offsets.empty() ? 1.0 : 0.0, sight.time_s});
  return robot.offsets.back();
}

/// Averages time and position with the same weights, which is exact for a constant velocity.
TrackPoint TrackBuilder::merge(Robot& robot) {
  const Detection& first = robot.frame.front();
  forget_offsets(robot, first.time_s);
  TrackPoint reference{first.time_s, first.x_m, first.y_m, first.yaw_rad};
  if (robot.last) {
    const Pose there = expected(robot, first.time_s);
    reference = {first.time_s, there.x_m, there.y_m, there.yaw_rad};
  }
  TrackPoint sum;
  double weights = 0.0;
  for (const Detection& sight : robot.frame) {
    const CameraOffset& known = offset_of(robot, sight, reference);
    const double w = weight(sight) * (kLeastTrust + known.trust_share);
    weights += w;
    sum.time_s += w * (sight.time_s - first.time_s);
    sum.x_m += w * (sight.x_m - known.offset.x_m - first.x_m);
    sum.y_m += w * (sight.y_m - known.offset.y_m - first.y_m);
    sum.yaw_rad += w * wrapped(sight.yaw_rad - known.offset.yaw_rad - first.yaw_rad);
  }
  const TrackPoint point{first.time_s + sum.time_s / weights, first.x_m + sum.x_m / weights, first.y_m + sum.y_m / weights,
                         first.yaw_rad + sum.yaw_rad / weights};
  if (robot.frame.size() > 1) {
    for (const Detection& sight : robot.frame) {
      CameraOffset& known = offset_of(robot, sight, point);
      const double later_s = point.time_s - sight.time_s;
      known.offset.x_m += kOffsetMemory * (sight.x_m + robot.rate.x_m * later_s - known.offset.x_m - point.x_m);
      known.offset.y_m += kOffsetMemory * (sight.y_m + robot.rate.y_m * later_s - known.offset.y_m - point.y_m);
      known.offset.yaw_rad += kOffsetMemory * wrapped(sight.yaw_rad + robot.rate.yaw_rad * later_s - known.offset.yaw_rad - point.yaw_rad);
      known.trust_share += kOffsetMemory * (1.0 - known.trust_share);
    }
  }
  return point;
}

void TrackBuilder::close_frame(Robot& robot) {
  if (!robot.frame.empty()) {
    choose_sights(robot);
    const TrackPoint point = merge(robot);
    robot.frame.clear();
    place(robot, point);
  }
}

void TrackBuilder::place(Robot& robot, TrackPoint point) {
  if (!robot.last) {
    append(robot, point);
    return;
  }
  const double step_s = point.time_s - robot.last->time_s;
  if (step_s < kShortestStep_s) {
    ++report().out_of_order;
    return;
  }
  if (step_s > kLongestBridge_s) {
    ++report().cuts;
    end_segment(robot);
    append(robot, point);
    return;
  }
  const double expected_yaw_rad = expected(robot, point.time_s).yaw_rad;
  if (!within_reach(*robot.last, point, expected_yaw_rad)) {
    go_on_elsewhere(robot, point);
    return;
  }
  point.yaw_rad = expected_yaw_rad + wrapped(point.yaw_rad - expected_yaw_rad);
  if (robot.usual_step_s && step_s > kMissingFrames * *robot.usual_step_s) {
    ++report().bridged_gaps;
  } else {
    const double usual_s = robot.usual_step_s.value_or(step_s);
    robot.usual_step_s = usual_s + 0.05 * (step_s - usual_s);
  }
  append(robot, point);
}

void TrackBuilder::go_on_elsewhere(Robot& robot, const TrackPoint& point) {
  ++report().outliers;
  if (!robot.elsewhere.empty()) {
    const TrackPoint& before = robot.elsewhere.back();
    if (point.time_s - before.time_s < kShortestStep_s || !within_reach(before, point, before.yaw_rad)) {
      robot.elsewhere.clear();
    }
  }
  robot.elsewhere.push_back(point);
  if (robot.elsewhere.size() < kTeleportConfirmed) {
    return;
  }
  report().outliers -= kTeleportConfirmed;
  const TrackSegment moved = std::move(robot.elsewhere);
  const bool had_a_track = robot.segment_points >= kFewestPoints;
  end_segment(robot);
  report().teleports += had_a_track ? 1 : 0;
  for (TrackPoint each : moved) {
    if (robot.last) {
      each.yaw_rad = robot.last->yaw_rad + wrapped(each.yaw_rad - robot.last->yaw_rad);
    }
    append(robot, each);
  }
}

bool TrackBuilder::keeps(const Robot& robot) const {
  return (!options_.robot || *options_.robot == robot.track.robot) && options_.most_points > 0;
}

void TrackBuilder::append(Robot& robot, const TrackPoint& point) {
  robot.elsewhere.clear();
  if (robot.last) {
    const double step_s = point.time_s - robot.last->time_s;
    robot.rate.x_m += kRateMemory * ((point.x_m - robot.last->x_m) / step_s - robot.rate.x_m);
    robot.rate.y_m += kRateMemory * ((point.y_m - robot.last->y_m) / step_s - robot.rate.y_m);
    robot.rate.yaw_rad += kRateMemory * ((point.yaw_rad - robot.last->yaw_rad) / step_s - robot.rate.yaw_rad);
  }
  summarise(robot, point);
  if (robot.segment_points == 0) {
    robot.segment_begin_s = point.time_s;
  }
  ++robot.segment_points;
  robot.last = point;
  if (!keeps(robot) || report().full_at_s) {
    return;
  }
  if (stored_ == options_.most_points) {
    report().full_at_s = point.time_s;
    return;
  }
  ++stored_;
  robot.segment.push_back(point);
}

void TrackBuilder::summarise(Robot& robot, const TrackPoint& point) {
  RobotSummary& summary = robot.summary;
  ++summary.points;
  if (robot.last) {
    summary.seen_s += point.time_s - robot.last->time_s;
  }
  const auto index = static_cast<std::int64_t>(std::floor(std::clamp(point.time_s, -1e9, 1e10) / kSummaryBin_s));
  auto& [oldest, middle, newest] = robot.bins;
  if (newest && index != newest->index) {
    const auto mean = [](const Bin& bin) {
      return TrackPoint{bin.sum.time_s / bin.count, bin.sum.x_m / bin.count, bin.sum.y_m / bin.count, 0.0};
    };
    if (middle && newest->index == middle->index + 1) {
      const TrackPoint b = mean(*middle);
      const TrackPoint c = mean(*newest);
      summary.path_m += std::hypot(c.x_m - b.x_m, c.y_m - b.y_m);
      if (oldest && middle->index == oldest->index + 1) {
        const TrackPoint a = mean(*oldest);
        const auto second = [&](double pa, double pb, double pc) {
          return 2.0 * ((pc - pb) / (c.time_s - b.time_s) - (pb - pa) / (b.time_s - a.time_s)) / (c.time_s - a.time_s);
        };
        const double magnitude = std::hypot(second(a.x_m, b.x_m, c.x_m), second(a.y_m, b.y_m, c.y_m));
        summary.effort_m2_per_s3 += magnitude * magnitude * kSummaryBin_s;
      }
    }
    oldest = middle;
    middle = newest;
    newest.reset();
  }
  if (!newest) {
    newest.emplace(Bin{.index = index, .sum = {}});
  }
  newest->count += 1.0;
  newest->sum.time_s += point.time_s;
  newest->sum.x_m += point.x_m;
  newest->sum.y_m += point.y_m;
}

void TrackBuilder::end_segment(Robot& robot) {
  if (robot.segment_points > 0) {
    const double length_s = robot.last->time_s - robot.segment_begin_s;
    const bool is_short = length_s < kShortestSegment_s || robot.segment_points < kFewestPoints;
    report().short_segments += is_short ? 1 : 0;
    if (is_short) {
      stored_ -= robot.segment.size();
    } else if (!robot.segment.empty()) {
      robot.segment.shrink_to_fit();
      robot.track.segments.push_back(std::move(robot.segment));
    }
  }
  robot.segment = {};
  robot.segment_points = 0;
  robot.last.reset();
  robot.rate = {};
  robot.bins = {};
  robot.elsewhere.clear();
}

void TrackBuilder::cut() {
  for (auto& [name, robot] : robots_) {
    close_frame(robot);
    end_segment(robot);
    robot.offsets.clear();
  }
}

void TrackBuilder::phase(GamePhase phase) {
  const double now_s = latest_s_.value_or(0.0);
  std::vector<PhaseSpan>& phases = game_.phases;
  if (!phases.empty() && phases.back().phase == phase) {
    return;
  }
  if (!phases.empty()) {
    phases.back().end_s = now_s;
    if (phases.back().end_s <= phases.back().begin_s) {
      phases.pop_back();
    }
  }
  if (phases.size() < kMostPhases) {
    phases.push_back({now_s, now_s, phase});
  }
}

void TrackBuilder::problem(std::uint64_t at, const LogFault& fault) {
  ++report().problems_in_all;
  if (report().problems.size() < kMostProblems) {
    report().problems.push_back({at, fault});
  }
}

RecordedGame TrackBuilder::finish() {
  cut();
  for (auto& [name, robot] : robots_) {
    if (!robot.track.segments.empty()) {
      game_.tracks.push_back(std::move(robot.track));
    }
    if (robot.summary.points >= kFewestPoints) {
      report().robots.push_back(robot.summary);
    }
  }
  if (first_s_) {
    report().span_s = std::min(*latest_s_, options_.until_s) - *first_s_;
  }
  if (!game_.phases.empty()) {
    game_.phases.back().end_s = std::max(game_.phases.back().begin_s, latest_s_.value_or(0.0));
  }
  return std::move(game_);
}

}  // namespace heatsoak::duty
