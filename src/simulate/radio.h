// Simulates the team's computer, which sees the robot through cameras and commands it through a radio link.
#pragma once

#include <array>
#include <cstdint>

#include "base/random.h"
#include "duty/match/generator.h"
#include "robot_core/drive_core.h"
#include "simulate/declared_number.h"

namespace heatsoak::simulate {

/// Parameters of radio link and vision. radio_numbers() declares unit, origin and range of each.
struct RadioConfig {
  double packet_rate_Hz = 100.0;     ///< infinite: a packet in every plant period
  double packet_latency_s = 0.005;   ///< time from the computation of a command to its reception
  double loss_share = 0.01;          ///< share of the packets that are lost
  double burst_count = 2.0;          ///< mean number of packets lost in a row
  double vision_rate_Hz = 75.0;      ///< infinite: a picture in every plant period
  double vision_latency_s = 0.025;   ///< time from exposure to the pose
  double vision_noise_m = 0.0006;    ///< standard deviation of a filtered position
  double vision_noise_rad = 0.004;   ///< standard deviation of a filtered yaw
  double position_gain_per_s = 4.0;  ///< commanded velocity per position error
  double heading_gain_per_s = 4.0;   ///< commanded yaw rate per yaw error
  double push_speed_m_per_s = 0.05;  ///< commanded velocity into another robot in a duel, in addition to the force
};
std::span<const DeclaredNumber<RadioConfig>> radio_numbers();

/// Returns the defaults with the robot's command_rate.
RadioConfig radio_of(const robot::Robot& robot);
/// Returns a link with a command in every plant period, without loss, latency or pose errors. The gains are twice the default, which the
/// missing latency permits.
RadioConfig ideal_radio();

/// Packet loss in bursts: a Markov chain with two states, one of which loses all packets (Gilbert, Bell System Technical Journal 39, 1960).
/// Share of loss and mean burst length are those of RadioConfig.
class PacketLoss {
 public:
  PacketLoss(double loss_share, double burst_count);
  bool arrives(base::Random& random);

 private:
  double begin_probability_;
  double end_probability_;
  bool is_lost_ = false;
};

/// Sends body velocities v = v_plan + k·(p_plan − p_seen), with v_plan extrapolated by the latency of the link. Plan and robot are compared
/// at the exposure of a picture, so the latency of vision alone causes no error. In a duel the command contains the force; along the force
/// push_speed replaces the correction. Loaded wheels creep, so a speed of zero would remove the force. Equal seeds give equal commands.
class OffBoard {
 public:
  /// Throws Failure (bad_input) that names the numbers outside their range.
  OffBoard(const RadioConfig& config, std::uint64_t seed);

  /// Computes the computer's command at `time_s`; `push` is the force on another robot, field frame. Must be called once per plant period,
  /// in order. Returns the command that the robot receives in this period, or null.
  const robot_core::Command* advance(double time_s, const duty::Follower& plan, const robot::Pose& truth, const robot::Wrench& push);

  [[nodiscard]] std::int64_t sent() const { return sent_; }
  [[nodiscard]] std::int64_t lost() const { return lost_; }

 private:
  /// Error (plan minus robot) in one picture.
  struct Picture {
    double ready_s = 0.0;
    robot::Pose error;
  };
  struct Packet {
    double ready_s = 0.0;
    robot_core::Command command;
  };
  /// Queue of entries in order of their time. If it is full, the oldest entry is dropped.
  template <class Entry>
  class Pipe {
   public:
    void push(const Entry& entry);
    /// Removes all entries that are ready and returns the newest of them, or null.
    const Entry* take(double time_s);

   private:
    std::array<Entry, 64> entries_{};
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    Entry taken_{};
  };

  void look(double time_s, const duty::Follower& plan, const robot::Pose& truth);
  [[nodiscard]] robot_core::Command command(const duty::Follower& plan, const robot::Wrench& push) const;

  RadioConfig config_;
  base::Random vision_random_;
  base::Random loss_random_;
  PacketLoss loss_;
  robot::Pose error_;  ///< newest known error
  Pipe<Picture> pictures_;
  Pipe<Packet> packets_;
  robot_core::Command received_;
  std::int64_t seen_ = 0;
  std::int64_t sent_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace heatsoak::simulate
