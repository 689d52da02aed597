#include <ssl_messages.pb.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/diagnostic.h"
#include "duty/capture_clock.h"
#include "duty/log_type.h"
#include "duty/ssl_log_stream.h"

namespace heatsoak::duty::logs {
namespace {

constexpr double kMillimetre_m = 1e-3;
constexpr std::int64_t kProbe_ns = 5'000'000'000;  // duration that probe() reads to find the sources of the log
constexpr std::size_t kMostTrackers = 64;
constexpr std::size_t kMostCameras = 64;
constexpr std::uint64_t kProgressBytes = std::uint64_t{1} << 24;

bool is_vision(SslMessageType type) { return type == SslMessageType::vision_2010 || type == SslMessageType::vision_2014; }

GamePhase phase_of_stage(std::uint32_t stage) {
  // Stages of half times, breaks and after the game. Stages before a kick-off are covered by their commands.
  constexpr std::array<std::uint32_t, 5> kOffPlay{2, 5, 8, 11, 13};
  return std::ranges::find(kOffPlay, stage) != kOffPlay.end() ? GamePhase::off_play : GamePhase::unknown;
}

/// Phases by published command number: HALT, STOP, NORMAL_START, FORCE_START, PREPARE_KICKOFF and _PENALTY (each yellow, blue),
/// DIRECT_FREE, INDIRECT_FREE, TIMEOUT, GOAL (to be treated as STOP), BALL_PLACEMENT.
constexpr std::array<GamePhase, 18> kPhaseOfCommand{
    GamePhase::halt,        GamePhase::stop,           GamePhase::running,       GamePhase::running, GamePhase::preparation,
    GamePhase::preparation, GamePhase::preparation,    GamePhase::preparation,   GamePhase::running, GamePhase::running,
    GamePhase::running,     GamePhase::running,        GamePhase::timeout,       GamePhase::timeout, GamePhase::stop,
    GamePhase::stop,        GamePhase::ball_placement, GamePhase::ball_placement};
constexpr std::uint32_t kLastStage = 13;

/// Source of positions that is used.
struct Source {
  bool tracked = false;
  std::string uuid;
  std::string name;
};

struct Sources {
  std::uint64_t vision_frames = 0;
  std::map<std::string, std::pair<std::string, std::uint64_t>> trackers;  ///< uuid -> name, frames
};

/// Receiver for probe(), which keeps nothing.
class NoEvents final : public LogEvents {
 public:
  void see(const Detection& /*detection*/) override {}
  void phase(GamePhase /*phase*/) override {}
  void cut() override {}
  void problem(std::uint64_t /*at*/, const LogFault& /*fault*/) override {}
  [[nodiscard]] bool done() const override { return false; }
  ImportReport& report() override { return report_; }

 private:
  ImportReport report_;
};

template <class Message>
bool decode(Message& message, std::string_view bytes) {
  return message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// Reads the log until robots were seen for a few seconds and returns its sources.
Sources probe(const std::filesystem::path& file) {
  LogBytes bytes(file);
  NoEvents nobody;
  SslLogStream stream(bytes, file, nobody);
  Sources sources;
  ssl::WrapperPacket vision;
  ssl::TrackerWrapperPacket tracked;
  std::int64_t first_ns = -1;
  while (const std::optional<SslRecord> record = stream.next()) {
    bool has_robots = false;
    if (is_vision(record->type)) {
      if (!decode(vision, record->message)) {
        stream.reject(MessageKind::vision);
        continue;
      }
      has_robots = vision.detection().robots_yellow_size() + vision.detection().robots_blue_size() > 0;
      sources.vision_frames += has_robots ? 1 : 0;
    } else if (record->type == SslMessageType::tracker_2020) {
      if (!decode(tracked, record->message)) {
        stream.reject(MessageKind::tracker);
        continue;
      }
      has_robots = tracked.tracked_frame().robots_size() > 0;
      if (has_robots && (sources.trackers.size() < kMostTrackers || sources.trackers.contains(tracked.uuid()))) {
        auto& [name, frames] = sources.trackers[tracked.uuid()];
        name = tracked.source_name();
        ++frames;
      }
    }
    if (has_robots && first_ns < 0) {
      first_ns = record->received_ns;
    }
    if (first_ns >= 0 && record->received_ns - first_ns > kProbe_ns) {
      break;
    }
  }
  return sources;
}

Source choose(const Sources& sources, MotionSource wanted) {
  const bool tracked =
      wanted == MotionSource::tracked || (wanted == MotionSource::automatic && sources.vision_frames == 0 && !sources.trackers.empty());
  Source best{.tracked = tracked, .uuid = {}, .name = {}};
  std::uint64_t most = 0;
  for (const auto& [uuid, tracker] : sources.trackers) {
    if (tracked && tracker.second > most) {
      most = tracker.second;
      best.uuid = uuid;
      best.name = tracker.first;
    }
  }
  return best;
}

class Import {
 public:
  Import(const std::filesystem::path& file, const ImportOptions& options, LogEvents& events)
      : options_(options), events_(events), source_(choose(probe(file), options.source)), bytes_(file), stream_(bytes_, file, events) {}

  void run() {
    std::uint64_t reported_offset = 0;
    while (const std::optional<SslRecord> record = stream_.next()) {
      ++events_.report().messages;
      take(*record);
      if (options_.progress && record->offset - reported_offset >= kProgressBytes) {
        reported_offset = record->offset;
        options_.progress(bytes_.share());
      }
      if (events_.done()) {
        break;
      }
    }
    ImportReport& report = events_.report();
    report.bytes = bytes_.offset();
    report.start_unix_s = clock_.start_unix_s();
    report.source = source_.tracked ? PositionSource{.kind = PositionSource::Kind::tracker, .tracker = source_.name}
                                    : PositionSource{.kind = PositionSource::Kind::vision, .cameras = cameras_.size()};
    if (bytes_.broken()) {
      report.notes.emplace_back(*bytes_.broken());
    }
    if (report.frames == 0) {
      report.notes.emplace_back(NoFrameWithRobots{report.source.kind});
    }
  }

 private:
  void take(const SslRecord& record) {
    if (is_vision(record.type)) {
      if (!decode(vision_, record.message)) {
        stream_.reject(MessageKind::vision);
      } else {
        learn_cameras(vision_.geometry());
        if (vision_.has_detection()) {
          take(vision_.detection(), record);
        }
      }
    } else if (record.type == SslMessageType::tracker_2020) {
      if (!decode(tracked_, record.message)) {
        stream_.reject(MessageKind::tracker);
      } else if (source_.tracked && tracked_.uuid() == source_.uuid) {
        take(tracked_.tracked_frame(), record);
      } else {
        ++events_.report().frames_of_other_sources;
      }
    } else if (record.type == SslMessageType::referee_2013) {
      take_referee(record);
    }
  }

  /// Returns the time of the frame since the start of the recording; nothing if it is not credible.
  std::optional<double> frame_time_s(int camera, double capture_s, const SslRecord& record) {
    ++events_.report().frames;
    const std::optional<CaptureClock::Reading> reading = clock_.read(camera, capture_s, record.received_ns);
    if (!reading) {
      ++events_.report().frames_out_of_time;
      return std::nullopt;
    }
    if (reading->jumped) {
      ++events_.report().clock_jumps;
      events_.report().frames_out_of_time -= static_cast<std::uint64_t>(CaptureClock::kConfirmed - 1);
      events_.cut();
    }
    return reading->time_s;
  }

  void take(const ssl::DetectionFrame& frame, const SslRecord& record) {
    if (source_.tracked) {
      ++events_.report().frames_of_other_sources;
      return;
    }
    const int camera = static_cast<int>(frame.camera_id() % kMostCameras);
    const std::optional<double> time_s = frame_time_s(camera, frame.t_capture(), record);
    if (!time_s) {
      return;
    }
    cameras_.insert(camera);
    const auto see = [&](Team team, const ssl::DetectionRobot& robot) {
      if (!robot.has_robot_id() || !robot.has_x() || !robot.has_y() || !robot.has_orientation()) {
        ++events_.report().implausible;
        return;
      }
      Detection detection{.robot = {team, static_cast<int>(robot.robot_id())},
                          .time_s = *time_s,
                          .x_m = static_cast<double>(robot.x()) * kMillimetre_m,
                          .y_m = static_cast<double>(robot.y()) * kMillimetre_m,
                          .yaw_rad = static_cast<double>(robot.orientation()),
                          .camera = camera,
                          .confidence = static_cast<double>(robot.confidence())};
      if (const auto at = camera_places_.find(camera); at != camera_places_.end()) {
        detection.camera_distance_m = std::hypot(detection.x_m - at->second.first, detection.y_m - at->second.second);
      }
      events_.see(detection);
    };
    for (const ssl::DetectionRobot& robot : frame.robots_yellow()) {
      see(Team::yellow, robot);
    }
    for (const ssl::DetectionRobot& robot : frame.robots_blue()) {
      see(Team::blue, robot);
    }
  }

  void take(const ssl::TrackedFrame& frame, const SslRecord& record) {
    const std::optional<double> time_s = frame_time_s(0, frame.timestamp(), record);
    if (!time_s) {
      return;
    }
    for (const ssl::TrackedRobot& robot : frame.robots()) {
      const std::uint32_t team = robot.robot_id().team_color();
      const bool is_in_sight = !robot.has_visibility() || robot.visibility() > 0.0F;
      if ((team != 1 && team != 2) || !robot.has_pos() || !robot.has_orientation() || !is_in_sight) {
        ++events_.report().implausible;
        continue;
      }
      events_.see({.robot = {team == 1 ? Team::yellow : Team::blue, static_cast<int>(robot.robot_id().id())},
                   .time_s = *time_s,
                   .x_m = static_cast<double>(robot.pos().x()),
                   .y_m = static_cast<double>(robot.pos().y()),
                   .yaw_rad = static_cast<double>(robot.orientation()),
                   .camera = 0,
                   .confidence = robot.has_visibility() ? static_cast<double>(robot.visibility()) : 1.0});
    }
  }

  void take_referee(const SslRecord& record) {
    if (!decode(referee_, record.message)) {
      stream_.reject(MessageKind::referee);
      return;
    }
    if (!referee_.has_command() || !referee_.has_stage() || referee_.command() >= kPhaseOfCommand.size() || referee_.stage() > kLastStage) {
      events_.problem(record.offset, RefereeUndefined{referee_.stage(), referee_.command()});
      return;
    }
    const GamePhase of_stage = phase_of_stage(referee_.stage());
    events_.phase(of_stage != GamePhase::unknown ? of_stage : kPhaseOfCommand[referee_.command()]);
  }

  void learn_cameras(const ssl::GeometryData& geometry) {
    for (const ssl::CameraCalibration& each : geometry.calib()) {
      const double x_m = static_cast<double>(each.derived_camera_world_tx()) * kMillimetre_m;
      const double y_m = static_cast<double>(each.derived_camera_world_ty()) * kMillimetre_m;
      if (each.has_derived_camera_world_tx() && each.has_derived_camera_world_ty() && std::hypot(x_m, y_m) < 100.0) {
        camera_places_[static_cast<int>(each.camera_id() % kMostCameras)] = {x_m, y_m};
      }
    }
  }

  const ImportOptions& options_;
  LogEvents& events_;
  Source source_;
  LogBytes bytes_;
  SslLogStream stream_;
  CaptureClock clock_;
  ssl::WrapperPacket vision_;
  ssl::TrackerWrapperPacket tracked_;
  ssl::Referee referee_;
  std::set<int> cameras_;
  std::map<int, std::pair<double, double>> camera_places_;
};

}  // namespace

LogType ssl_log() {
  return {.name = {},
          .summary = "SSL_LOG_FILE of the Small Size League, .log or .log.gz, with vision or tracker",
          .recognises = [](std::string_view head) { return head.starts_with(kSslMagic); },
          .read = [](const std::filesystem::path& file, const ImportOptions& options,
                     LogEvents& events) { Import(file, options, events).run(); }};
}

}  // namespace heatsoak::duty::logs
