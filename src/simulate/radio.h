// The team's computer beside the field: it sees the robot through cameras and commands it through a radio link.
#pragma once

#include <array>
#include <cstdint>

#include "base/random.h"
#include "duty/match/generator.h"
#include "robot_core/drive_core.h"
#include "simulate/declared_number.h"

namespace heatsoak::simulate {

/// radio_numbers() has unit, origin and range of every number.
struct RadioConfig {
  double packet_rate_Hz = 100.0;    ///< infinite: a packet in every period of the plant
  double packet_latency_s = 0.005;  ///< from computing a command to its reception
  double loss_share = 0.01;         ///< of the packets
  double burst_count = 2.0;         ///< mean number of packets lost in a row
  double vision_rate_Hz = 75.0;     ///< infinite: in every period of the plant
  double vision_latency_s = 0.025;  ///< from exposure to the pose that the planner can use
  double vision_noise_m = 0.0006;   ///< standard deviation of one filtered pose
  double vision_noise_rad = 0.004;
  double position_gain_per_s = 4.0;  ///< velocity per distance between plan and robot
  double heading_gain_per_s = 4.0;
  double push_speed_m_per_s = 0.05;  ///< into another robot, besides the force
};
std::span<const DeclaredNumber<RadioConfig>> radio_numbers();

/// The defaults with the robot's own command_rate.
RadioConfig radio_of(const robot::Robot& robot);
/// A command in every period of the plant, no loss, no latency, exact poses; twice the default's gains, as nothing is late.
RadioConfig ideal_radio();

/// Which packets arrive: two states, in one of which all are lost (Gilbert, Bell System Technical Journal 39, 1960). The shares of loss
/// and the mean length of a burst are those of the configuration.
class PacketLoss {
 public:
  PacketLoss(double loss_share, double burst_count);
  bool arrives(base::Random& random);

 private:
  double begin_probability_;
  double end_probability_;
  bool is_lost_ = false;
};

/// Sends body velocities: the plan's, led by the link's latency, with v = v_plan + k·(p_plan − p_seen). Plan and robot are compared at
/// the exposure of a picture, so that the latency of vision alone makes no error. In a duel the command has the force, and in its direction
/// push_speed in place of the correction: wheels that pass on a force creep, and a speed of zero would take the force away again. Same
/// seed, same commands.
class OffBoard {
 public:
  /// Throws Failure (bad_input) that names the numbers outside of their range.
  OffBoard(const RadioConfig& config, std::uint64_t seed);

  /// What the computer has to say at `time_s`; `push` is the force on another robot, field frame. Call once per period of the plant, in
  /// order. Returns the command that the robot receives in this period, or null.
  const robot_core::Command* advance(double time_s, const duty::Follower& plan, const robot::Pose& truth, const robot::Wrench& push);

  [[nodiscard]] std::int64_t sent() const { return sent_; }
  [[nodiscard]] std::int64_t lost() const { return lost_; }

 private:
  /// Distance between plan and robot in one picture.
  struct Picture {
    double ready_s = 0.0;
    robot::Pose error;
  };
  struct Packet {
    double ready_s = 0.0;
    robot_core::Command command;
  };
  /// Entries in order of their time; the oldest is dropped where there are too many.
  template <class Entry>
  class Pipe {
   public:
    void push(const Entry& entry);
    /// The newest entry that is ready, or null.
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
  robot::Pose error_;  ///< newest that is known
  Pipe<Picture> pictures_;
  Pipe<Packet> packets_;
  robot_core::Command received_;
  std::int64_t seen_ = 0;
  std::int64_t sent_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace heatsoak::simulate
