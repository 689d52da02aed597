#include "simulate/radio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulate/sensing.h"

namespace heatsoak::simulate {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Tolerance for comparing times: far below a plant period, far above rounding errors.
constexpr double kInstant_s = 1e-9;

constexpr DeclaredNumber<RadioConfig> kRadioNumbers[] = {
    {{"packet_rate", "Hz", base::Range{1.0, kInfinite}, "rate of the commands to one robot"},
     &RadioConfig::packet_rate_Hz,
     base::Origin::estimated,
     base::Range::between(50.0, 200.0),
     "teams of the league send 60 to 200 Hz; RoboTeam Twente 60 Hz (its robots' files have it)"},
    {{"packet_latency", "s", base::Range::between(0.0, 0.5), "time from computing a command to its reception"},
     &RadioConfig::packet_latency_s,
     base::Origin::estimated,
     base::Range::between(0.002, 0.02),
     "USB to the base station 1 ms, a slot of a round over eleven robots, 0.4 ms in the air at 1.3 Mbit/s; engineering judgement"},
    {{"loss", "1", base::Range::between(0.0, 0.5), "share of the packets that are lost"},
     &RadioConfig::loss_share,
     base::Origin::estimated,
     base::Range::between(0.0, 0.1),
     "2.4 GHz in a hall full of networks; engineering judgement"},
    {{"burst", "1", base::Range::between(1.0, 1e4), "mean number of packets lost in a row"},
     &RadioConfig::burst_count,
     base::Origin::estimated,
     base::Range::between(1.0, 10.0),
     "a packet of a wireless network covers one or two slots; engineering judgement"},
    {{"vision_rate", "Hz", base::Range{1.0, kInfinite}, "picture rate of the cameras above the field"},
     &RadioConfig::vision_rate_Hz,
     base::Origin::third_party,
     base::Range::between(60.0, 110.0),
     "cameras of SSL-Vision at tournaments run at 60 to 110 Hz"},
    {{"vision_latency", "s", base::Range::between(0.0, 0.5), "time from exposure to a filtered pose"},
     &RadioConfig::vision_latency_s,
     base::Origin::estimated,
     base::Range::between(0.015, 0.06),
     "exposure and read-out 10 ms, detection 5 ms, network and filter 10 ms; engineering judgement"},
    {{"vision_noise", "m", base::Range::between(0.0, 0.5), "standard deviation of a filtered position"},
     &RadioConfig::vision_noise_m,
     base::Origin::estimated,
     base::Range::between(0.0003, 0.003),
     "a pixel is 3 to 5 mm of the field, the centres of five markers are averaged: 1 mm; a filter over three pictures; engineering "
     "judgement"},
    {{"vision_noise_yaw", "rad", base::Range::between(0.0, 0.5), "standard deviation of a filtered heading"},
     &RadioConfig::vision_noise_rad,
     base::Origin::estimated,
     base::Range::between(0.003, 0.02),
     "markers 60 to 80 mm from the centre, each seen to 0.5 mm: 6 mrad; a filter over three pictures; engineering judgement"},
    {{"position_gain", "s-1", base::Range::between(0.0, 100.0), "velocity per distance between plan and robot"},
     &RadioConfig::position_gain_per_s,
     base::Origin::estimated,
     base::Range::between(1.0, 8.0),
     "a quarter of 1/(delay of vision, radio and the core's velocity control, 60 ms); engineering judgement"},
    {{"heading_gain", "s-1", base::Range::between(0.0, 100.0), "yaw rate per angle between plan and robot"},
     &RadioConfig::heading_gain_per_s,
     base::Origin::estimated,
     base::Range::between(1.0, 8.0),
     "as position_gain"},
    {{"push_speed", "m/s", base::Range::between(0.0, 2.0), "speed that is commanded into another robot in a duel"},
     &RadioConfig::push_speed_m_per_s,
     base::Origin::estimated,
     base::Range::between(0.02, 0.5),
     "the creep of wheels that use 0.7 of their grip (slip_speed of the robots' files): the loss of speed by a push"}};

double wrapped_rad(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

/// Returns whether entry number `count` of a stream of `rate_Hz` is due; always true for an infinite rate.
bool is_due(double time_s, double rate_Hz, std::int64_t count) {
  return std::isinf(rate_Hz) || time_s >= static_cast<double>(count) / rate_Hz - kInstant_s;
}

}  // namespace

std::span<const DeclaredNumber<RadioConfig>> radio_numbers() { return kRadioNumbers; }

RadioConfig radio_of(const robot::Robot& robot) {
  RadioConfig config;
  config.packet_rate_Hz = robot.drive.command_rate_Hz.value_or(config.packet_rate_Hz);
  return config;
}

RadioConfig ideal_radio() {
  RadioConfig config;
  config.packet_rate_Hz = config.vision_rate_Hz = kInfinite;
  config.packet_latency_s = config.vision_latency_s = 0.0;
  config.loss_share = 0.0;
  config.vision_noise_m = config.vision_noise_rad = 0.0;
  config.position_gain_per_s *= 2.0;
  config.heading_gain_per_s *= 2.0;
  return config;
}

// For a share of loss p and a mean burst length b: end = 1/b, begin = end·p/(1 − p).
PacketLoss::PacketLoss(double loss_share, double burst_count)
    : begin_probability_(loss_share / ((1.0 - loss_share) * burst_count)), end_probability_(1.0 / burst_count) {}

bool PacketLoss::arrives(base::Random& random) {
  const double draw = random.uniform();
  is_lost_ = is_lost_ ? draw >= end_probability_ : draw < begin_probability_;
  return !is_lost_;
}

template <class Entry>
void OffBoard::Pipe<Entry>::push(const Entry& entry) {
  if (size_ == entries_.size()) {
    first_ = (first_ + 1) % entries_.size();
    --size_;
  }
  entries_[(first_ + size_++) % entries_.size()] = entry;
}

template <class Entry>
const Entry* OffBoard::Pipe<Entry>::take(double time_s) {
  bool is_ready = false;
  for (; size_ > 0 && entries_[first_].ready_s <= time_s + kInstant_s; --size_) {
    taken_ = entries_[first_];
    first_ = (first_ + 1) % entries_.size();
    is_ready = true;
  }
  return is_ready ? &taken_ : nullptr;
}

OffBoard::OffBoard(const RadioConfig& config, std::uint64_t seed)
    : config_(config), vision_random_(seed, 2), loss_random_(seed, 3), loss_(config.loss_share, config.burst_count) {
  require_declared_ranges(config, radio_numbers());
}

void OffBoard::look(double time_s, const duty::Follower& plan, const robot::Pose& truth) {
  if (is_due(time_s, config_.vision_rate_Hz, seen_)) {
    ++seen_;
    const robot::Pose planned = plan.pose();
    Picture picture{time_s + config_.vision_latency_s,
                    {planned.x_m - truth.x_m, planned.y_m - truth.y_m, wrapped_rad(planned.yaw_rad - truth.yaw_rad)}};
    if (config_.vision_noise_m > 0.0 || config_.vision_noise_rad > 0.0) {
      picture.error.x_m -= config_.vision_noise_m * noise(vision_random_);
      picture.error.y_m -= config_.vision_noise_m * noise(vision_random_);
      picture.error.yaw_rad -= config_.vision_noise_rad * noise(vision_random_);
    }
    pictures_.push(picture);
  }
  if (const Picture* const newest = pictures_.take(time_s)) {
    error_ = newest->error;
  }
}

robot_core::Command OffBoard::command(const duty::Follower& plan, const robot::Wrench& push) const {
  const double lead_s = config_.packet_latency_s;
  const robot::BodyVelocity planned = plan.velocity_global();
  const robot::BodyAcceleration acceleration = plan.acceleration_global();
  // Predicted yaw of the robot when the packet arrives: the last seen yaw, advanced by the motion of the plan.
  const double yaw_rad = plan.pose().yaw_rad - error_.yaw_rad + lead_s * planned.yaw_rad_per_s;
  double x_m_per_s = config_.position_gain_per_s * error_.x_m;
  double y_m_per_s = config_.position_gain_per_s * error_.y_m;
  if (const double force_N = std::hypot(push.x_N, push.y_N); force_N > 0.0) {
    const double x_share = push.x_N / force_N;
    const double y_share = push.y_N / force_N;
    const double replaced_m_per_s = x_m_per_s * x_share + y_m_per_s * y_share - config_.push_speed_m_per_s;
    x_m_per_s -= replaced_m_per_s * x_share;
    y_m_per_s -= replaced_m_per_s * y_share;
  }
  const robot::BodyVelocity wanted{
      planned.x_m_per_s + lead_s * acceleration.x_m_per_s2 + x_m_per_s, planned.y_m_per_s + lead_s * acceleration.y_m_per_s2 + y_m_per_s,
      planned.yaw_rad_per_s + lead_s * acceleration.yaw_rad_per_s2 + config_.heading_gain_per_s * error_.yaw_rad};
  const robot::BodyVelocity velocity = robot::to_local(wanted, yaw_rad);
  const robot::BodyAcceleration local = robot::to_local(acceleration, yaw_rad);
  const robot::Wrench force = robot::to_local(push, yaw_rad);
  robot_core::Command made;
  made.mode = robot_core::Mode::body_velocity;
  made.velocity = {static_cast<float>(velocity.x_m_per_s), static_cast<float>(velocity.y_m_per_s),
                   static_cast<float>(velocity.yaw_rad_per_s)};
  made.acceleration = {static_cast<float>(local.x_m_per_s2), static_cast<float>(local.y_m_per_s2),
                       static_cast<float>(local.yaw_rad_per_s2)};
  made.push = {static_cast<float>(force.x_N), static_cast<float>(force.y_N), static_cast<float>(force.yaw_Nm)};
  return made;
}

const robot_core::Command* OffBoard::advance(double time_s, const duty::Follower& plan, const robot::Pose& truth,
                                             const robot::Wrench& push) {
  look(time_s, plan, truth);
  if (is_due(time_s, config_.packet_rate_Hz, sent_)) {
    ++sent_;
    if (loss_.arrives(loss_random_)) {
      packets_.push({time_s + config_.packet_latency_s, command(plan, push)});
    } else {
      ++lost_;
    }
  }
  const Packet* const newest = packets_.take(time_s);
  if (newest == nullptr) {
    return nullptr;
  }
  received_ = newest->command;
  return &received_;
}

}  // namespace heatsoak::simulate
