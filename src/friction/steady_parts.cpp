#include "friction/steady_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/unknown.h"
#include "friction/block_medians.h"
#include "friction/robust_fit.h"

namespace heatsoak::friction {
namespace {

constexpr Eigen::Index kLeastBlocks = 5;
constexpr double kCusumLimit_factor = 1.95;
constexpr double kRelevant_share = 0.005;
constexpr double kSameLevel_share = 0.1;
constexpr double kAtRest_share = 0.03;
constexpr double kRestless_share = 0.3;
constexpr double kTurn_rad = 30.0 * std::numbers::pi / 180.0;

enum class Movement { standing, translating, rotating, unknown };

struct Block {
  Movement kind = Movement::unknown;
  robot::BodyVelocity velocity;
  double direction_rad = 0.0;
};

struct Leg {
  Eigen::Index begin = 0;
  Eigen::Index end = 0;
  Movement kind = Movement::unknown;
  bool is_return = false;
};

double angle_between(double a_rad, double b_rad) { return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi)); }

std::vector<Block> classified(const BlockMedians& medians, const robot::Kinematics& kinematics) {
  const double rim_m_per_s = kinematics.wheel_radius_m * medians.top.head(kinematics.wheel_count).maxCoeff();
  std::vector<Block> blocks(medians.first_row.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    robot::PerWheel speed_rad_per_s{};
    Eigen::VectorXd::Map(speed_rad_per_s.data(), kinematics.wheel_count) =
        medians.values.col(static_cast<Eigen::Index>(k)).head(kinematics.wheel_count);
    Block& block = blocks[k];
    block.velocity = robot::body_velocity(kinematics, speed_rad_per_s);
    const double moving_m_per_s = std::hypot(block.velocity.x_m_per_s, block.velocity.y_m_per_s);
    const double turning_m_per_s = kinematics.contact_radius_m * std::abs(block.velocity.yaw_rad_per_s);
    block.direction_rad = std::atan2(block.velocity.y_m_per_s, block.velocity.x_m_per_s);
    if (!std::isfinite(moving_m_per_s + turning_m_per_s)) {
      block.kind = Movement::unknown;
    } else if (std::max(moving_m_per_s, turning_m_per_s) <= kAtRest_share * rim_m_per_s) {
      block.kind = Movement::standing;
    } else {
      block.kind = turning_m_per_s > moving_m_per_s ? Movement::rotating : Movement::translating;
    }
  }
  return blocks;
}

std::vector<Leg> legs_of(const std::vector<Block>& blocks) {
  std::vector<Leg> legs;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Block& block = blocks[k];
    const bool goes_on =
        k > 0 && block.kind == blocks[k - 1].kind &&
        (block.kind != Movement::translating || angle_between(block.direction_rad, blocks[k - 1].direction_rad) < kTurn_rad) &&
        (block.kind != Movement::rotating || block.velocity.yaw_rad_per_s * blocks[k - 1].velocity.yaw_rad_per_s > 0.0);
    const auto at = static_cast<Eigen::Index>(k);
    if (!goes_on) {
      legs.push_back({at, at, block.kind, false});
    }
    legs.back().end = at + 1;
  }
  std::erase_if(legs, [](const Leg& leg) { return leg.kind == Movement::standing || leg.kind == Movement::unknown; });
  return legs;
}

/// Marks return legs: at their end the robot is less than half as far from where it came from as at their begin.
void mark_returns(std::vector<Leg>& legs, const std::vector<Block>& blocks, const BlockMedians& medians, const FrictionLog& log) {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  std::size_t k = 0;
  for (Leg& leg : legs) {
    double begin_m = 0.0;
    double path_m = 0.0;
    for (; k < static_cast<std::size_t>(leg.end); ++k) {
      if (static_cast<Eigen::Index>(k) == leg.begin) {
        begin_m = std::hypot(x_m, y_m);
      }
      if (blocks[k].kind == Movement::unknown) {
        continue;
      }
      const double measured_rad = log.yaw_rad.empty() ? std::numeric_limits<double>::quiet_NaN() : log.yaw_rad[medians.first_row[k]];
      const robot::BodyVelocity field = robot::to_global(blocks[k].velocity, std::isfinite(measured_rad) ? measured_rad : yaw_rad);
      const double duration_s = medians.duration_s[k];
      x_m += field.x_m_per_s * duration_s;
      y_m += field.y_m_per_s * duration_s;
      yaw_rad += field.yaw_rad_per_s * duration_s;
      path_m += static_cast<Eigen::Index>(k) >= leg.begin ? std::hypot(field.x_m_per_s, field.y_m_per_s) * duration_s : 0.0;
    }
    // The minimum length excludes short corrections near the start.
    leg.is_return = leg.kind == Movement::translating && std::hypot(x_m, y_m) < 0.5 * begin_m && path_m > 0.5 * begin_m;
    if (leg.is_return) {
      x_m = y_m = 0.0;
    }
  }
}

struct Change {
  Eigen::Index at = 0;
  double sum_ratio = 0.0;  ///< largest cumulative sum divided by its limit from noise
};

/// Per signal, true if its wheel turns in this leg. A wheel that should stand sticks and slips irregularly.
std::vector<bool> turning_signals(const BlockMedians& medians, const std::vector<Block>& blocks, const Leg& leg,
                                  const robot::Kinematics& kinematics) {
  std::vector<bool> turns(static_cast<std::size_t>(medians.values.rows()), true);
  if (leg.kind != Movement::translating) {
    return turns;
  }
  std::vector<double> x, y;
  for (Eigen::Index k = leg.begin; k < leg.end; ++k) {
    x.push_back(std::cos(blocks[static_cast<std::size_t>(k)].direction_rad));
    y.push_back(std::sin(blocks[static_cast<std::size_t>(k)].direction_rad));
  }
  const double heading_rad = std::atan2(median(y), median(x));
  for (std::size_t signal = 0; signal < turns.size(); ++signal) {
    const std::size_t wheel = signal % static_cast<std::size_t>(kinematics.wheel_count);
    turns[signal] = !should_stand(kinematics.wheels[wheel], heading_rad);
  }
  return turns;
}

/// Returns the most significant relevant change of a mean within [begin, end), or nullopt.
std::optional<Change> change_within(const BlockMedians& blocks, const std::vector<bool>& counts, Eigen::Index begin, Eigen::Index end) {
  std::optional<Change> found;
  const Eigen::Index size = end - begin;
  for (Eigen::Index signal = 0; signal < blocks.values.rows(); ++signal) {
    if (!counts[static_cast<std::size_t>(signal)]) {
      continue;
    }
    const Eigen::RowVectorXd values = blocks.values.row(signal).segment(begin, size);
    const double limit = kCusumLimit_factor * block_deviation(blocks, signal, begin, end) * std::sqrt(static_cast<double>(size));
    const double mean = values.mean();
    double sum = 0.0;
    double left = 0.0;
    Change change;
    double left_at_change = 0.0;
    for (Eigen::Index i = 0; i + 1 < size; ++i) {
      sum += values(i) - mean;
      left += values(i);
      if (std::abs(sum) > limit * std::max(1.0, change.sum_ratio)) {
        change = {begin + i + 1, std::abs(sum) / limit};
        left_at_change = left;
      }
    }
    if (change.at == 0) {
      continue;
    }
    const double before = left_at_change / static_cast<double>(change.at - begin);
    const double after = (values.sum() - left_at_change) / static_cast<double>(end - change.at);
    const double matters = kRelevant_share * std::max({std::abs(before), std::abs(after), 0.1 * blocks.top(signal)});
    if (std::abs(after - before) > matters && (!found || change.sum_ratio > found->sum_ratio)) {
      found = change;
    }
  }
  return found;
}

/// Returns the undivided segments of a leg as [begin, end) of blocks.
std::vector<std::pair<Eigen::Index, Eigen::Index>> steady_segments(const BlockMedians& blocks, const std::vector<bool>& counts,
                                                                   const Leg& leg) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> open{{leg.begin, leg.end}};
  std::vector<std::pair<Eigen::Index, Eigen::Index>> steady;
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    if (end - begin < kLeastBlocks || !blocks.values.middleCols(begin, end - begin).allFinite()) {
      continue;
    }
    if (const std::optional<Change> change = change_within(blocks, counts, begin, end)) {
      open.emplace_back(change->at, end);
      open.emplace_back(begin, change->at);
    } else {
      steady.emplace_back(begin, end);
    }
  }
  return steady;
}

std::span<const double> rows_of(const std::vector<double>& column, const SteadyPart& part) {
  return std::span(column).subspan(part.first_row, part.row_count);
}

/// Direction of travel from the log, or else from the wheels.
double heading_rad(const FrictionLog& log, const SteadyPart& part, const robot::BodyVelocity& velocity) {
  if (!log.heading_rad.empty()) {
    std::vector<double> x, y;
    for (const double angle_rad : rows_of(log.heading_rad, part)) {
      x.push_back(std::cos(angle_rad));
      y.push_back(std::sin(angle_rad));
    }
    const std::optional<double> along = robust_location(x, 1e-3).value;
    const std::optional<double> across = robust_location(y, 1e-3).value;
    if (along && across) {
      return std::atan2(*across, *along);
    }
  }
  return std::atan2(velocity.y_m_per_s, velocity.x_m_per_s);
}

SteadyPart measured_part(const FrictionLog& log, const robot::Kinematics& kinematics, SteadyPart part, const BlockMedians& blocks) {
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const auto wheel = static_cast<std::size_t>(i);
    const RobustLocation speed = robust_location(rows_of(log.wheel_speed_rad_per_s[wheel], part), blocks.resolution(i));
    part.wheel_speed_rad_per_s[i] = speed.value.value_or(base::kUnknown);
    part.speed_noise_rad_per_s[i] = speed.noise;
    const bool has_voltage = !log.voltage_V[wheel].empty();
    RobustLocation voltage;
    if (has_voltage) {
      voltage = robust_location(rows_of(log.voltage_V[wheel], part), blocks.resolution(kinematics.wheel_count + i));
      part.voltage_V[i] = voltage.value.value_or(base::kUnknown);
    }
    for (std::size_t row = 0; row < part.row_count; ++row) {
      part.rows_kept[wheel] += speed.kept[row] && (!has_voltage || voltage.kept[row]) ? 1 : 0;
    }
  }
  const robot::BodyVelocity velocity = robot::body_velocity(kinematics, part.wheel_speed_rad_per_s);
  part.heading_rad = heading_rad(log, part, velocity);
  part.speed_m_per_s = std::hypot(velocity.x_m_per_s, velocity.y_m_per_s);
  part.yaw_rad_per_s = velocity.yaw_rad_per_s;
  return part;
}

/// True if the noise is a large part of the speed, which means that the controller oscillates.
bool is_restless(const SteadyPart& part) {
  const auto* const fastest = std::ranges::max_element(part.wheel_speed_rad_per_s, {}, [](double speed) { return std::abs(speed); });
  return part.speed_noise_rad_per_s[static_cast<std::size_t>(fastest - part.wheel_speed_rad_per_s.begin())] >
         kRestless_share * std::abs(*fastest);
}

/// Keeps only the longest of successive parts at one speed, because the others are transients towards or from it.
std::vector<SteadyPart> settled(const std::vector<SteadyPart>& parts) {
  std::vector<SteadyPart> kept;
  for (const SteadyPart& part : parts) {
    const auto level = [](const SteadyPart& each) { return std::max(each.speed_m_per_s, std::abs(each.yaw_rad_per_s)); };
    if (kept.empty() || std::abs(level(part) - level(kept.back())) > kSameLevel_share * level(part)) {
      kept.push_back(part);
    } else if (part.row_count > kept.back().row_count) {
      kept.back() = part;
    }
  }
  return kept;
}

void add_run(const FrictionLog& log, const robot::Kinematics& kinematics, std::size_t begin, std::size_t end, SteadyParts& found) {
  const BlockMedians medians = block_medians(log, kinematics.wheel_count, begin, end);
  if (medians.first_row.size() < static_cast<std::size_t>(kLeastBlocks)) {
    return;
  }
  const std::vector<Block> blocks = classified(medians, kinematics);
  std::vector<Leg> legs = legs_of(blocks);
  mark_returns(legs, blocks, medians, log);
  for (const Leg& leg : legs) {
    std::vector<SteadyPart> parts;
    for (const auto& [first, last] : steady_segments(medians, turning_signals(medians, blocks, leg, kinematics), leg)) {
      SteadyPart part;
      part.leg = found.legs;
      part.is_return = leg.is_return;
      part.is_rotation = leg.kind == Movement::rotating;
      part.first_row = medians.first_row[static_cast<std::size_t>(first)];
      part.row_count = static_cast<std::size_t>(last - first) * medians.rows_per_block;
      part = measured_part(log, kinematics, part, medians);
      if (!is_restless(part)) {
        parts.push_back(part);
      }
    }
    for (const SteadyPart& part : settled(parts)) {
      found.parts.push_back(part);
      found.rows_steady += part.row_count;
    }
    if (!parts.empty()) {
      ++found.legs;
      found.return_legs += leg.is_return ? 1 : 0;
    }
  }
}

}  // namespace

double rolling_share(const robot::WheelDirections& wheel, double heading_rad) {
  return wheel.rolling_x_share * std::cos(heading_rad) + wheel.rolling_y_share * std::sin(heading_rad);
}

bool should_stand(const robot::WheelDirections& wheel, double heading_rad) { return std::abs(rolling_share(wheel, heading_rad)) < 0.1; }

SteadyParts find_steady_parts(const std::vector<FrictionLog>& logs, const robot::Kinematics& kinematics) {
  SteadyParts found;
  for (const FrictionLog& log : logs) {
    found.rows += log.rows();
    for (std::size_t i = 0; i < log.run_begins.size(); ++i) {
      const std::size_t end = i + 1 < log.run_begins.size() ? log.run_begins[i + 1] : log.rows();
      add_run(log, kinematics, log.run_begins[i], end, found);
    }
  }
  return found;
}

}  // namespace heatsoak::friction
