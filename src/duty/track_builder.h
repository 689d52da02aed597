// Builds tracks from single detections: merges cameras, rejects outliers, bridges or cuts gaps.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "duty/log_type.h"

namespace heatsoak::duty {

class TrackBuilder final : public LogEvents {
 public:
  explicit TrackBuilder(const ImportOptions& options) : options_(options) {}

  void see(const Detection& detection) override;
  void phase(GamePhase phase) override;
  void cut() override;
  void problem(std::uint64_t at, const LogFault& fault) override;
  [[nodiscard]] bool done() const override { return latest_s_ && *latest_s_ > options_.until_s; }
  ImportReport& report() override { return game_.report; }

  /// Ends all tracks and returns the game. The builder must not be used afterwards.
  RecordedGame finish();

 private:
  /// Planar vector and yaw.
  struct Pose {
    double x_m = 0.0;
    double y_m = 0.0;
    double yaw_rad = 0.0;
  };
  /// Offset of a camera at the robot's position. Cameras disagree by centimetres, so it is estimated for each robot.
  struct CameraOffset {
    int camera = 0;
    Pose offset;
    double trust_share = 0.0;  ///< 0 to 1, grows with the frames shared with another camera
    double seen_s = 0.0;       ///< time of the last detection
  };
  /// Average over 0.1 s. The last three bins give an acceleration.
  struct Bin {
    std::int64_t index = 0;
    double count = 0.0;
    TrackPoint sum;
  };
  struct Robot {
    RobotTrack track;
    RobotSummary summary;
    std::vector<Detection> frame;  ///< detections that may form one point
    std::vector<CameraOffset> offsets;
    TrackSegment segment;
    std::optional<TrackPoint> last;
    Pose rate;                           ///< smoothed velocity, for the expected position of the next point
    std::optional<double> usual_step_s;  ///< usual time between points; empty before the second point
    TrackSegment elsewhere;              ///< points out of reach: outliers, or a robot that was moved
    std::array<std::optional<Bin>, 3> bins;
    std::uint64_t segment_points = 0;
    double segment_begin_s = 0.0;
  };

  [[nodiscard]] static bool is_plausible(const Detection& detection);
  [[nodiscard]] bool keeps(const Robot& robot) const;
  [[nodiscard]] static Pose expected(const Robot& robot, double time_s);
  void close_frame(Robot& robot);
  void choose_sights(Robot& robot);
  static void forget_offsets(Robot& robot, double now_s);
  static TrackPoint merge(Robot& robot);
  static CameraOffset& offset_of(Robot& robot, const Detection& sight, const TrackPoint& reference);
  void place(Robot& robot, TrackPoint point);
  void go_on_elsewhere(Robot& robot, const TrackPoint& point);
  void append(Robot& robot, const TrackPoint& point);
  static void summarise(Robot& robot, const TrackPoint& point);
  void end_segment(Robot& robot);

  const ImportOptions& options_;
  std::map<RobotName, Robot> robots_;
  RecordedGame game_;
  std::optional<double> first_s_;   ///< time of the first detection within the imported range
  std::optional<double> latest_s_;  ///< time of the latest plausible detection
  std::size_t stored_ = 0;
};

}  // namespace heatsoak::duty
