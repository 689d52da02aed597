#include "duty/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "duty/jerk_smoother.h"

namespace heatsoak::duty {
namespace {

constexpr double kFramesPerPeriod = 6.0;  // fewer samples per period do not determine its acceleration
constexpr double kHuber = 2.5;            // in robust standard deviations: beyond it the influence of a point is constant
constexpr double kOutlier = 6.0;          // in robust standard deviations: beyond it a point has weight 0
constexpr int kReweightings = 3;
constexpr double kNormal = 1.4826;  // ratio of standard deviation to median absolute deviation of a normal distribution
// Lower bounds of the noise that scales residuals. Without noise the smoother's own error at a hard start would count as an outlier.
constexpr double kNoSuspicion_m = 2e-3;
constexpr double kNoSuspicion_rad = 1e-2;
// A wider band adds more heat by noise, a narrower one loses more at the edges of the acceleration. Turns are shorter than straight runs
// and lose more.
constexpr double kNoiseShareOfPlace = 0.02;
constexpr double kNoiseShareOfTurn = 0.045;
constexpr double kFirstBandwidth_Hz = 4.0;
constexpr double kLeastBandwidth_Hz = 2.0;
constexpr double kMostBandwidth_Hz = 8.0;
constexpr int kBandwidthSearch = 3;
constexpr double kQuietBandwidth_Hz = 1.5;
constexpr double kWindow_s = 0.25;  // half width of the window that decides whether the robot is quiet
// The mean square over this window has about ten degrees of freedom. Noise alone exceeds three times its mean in 0.1 % of the windows.
constexpr double kMoreThanNoise = 3.0;
constexpr std::size_t kBlock = 4096;
constexpr double kMemoryPeriods = 5.0;  // in periods of the quiet bandwidth: samples farther away have no influence (e^-18)

double median(std::vector<double>& values) {
  if (values.empty()) {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Smooths block by block, which needs memory for one block only. The result is the same as for all samples together.
std::vector<Smoothed> smooth_in_blocks(const std::vector<Sample>& samples, double step_s, double memory_s) {
  std::vector<Smoothed> all;
  all.reserve(samples.size());
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, samples.size());
    const auto first = std::ranges::lower_bound(samples, samples[begin].time_s - memory_s, {}, &Sample::time_s);
    const auto last = std::ranges::upper_bound(samples, samples[end - 1].time_s + memory_s, {}, &Sample::time_s);
    const std::vector<Smoothed> block = smooth_samples({first, last}, step_s);
    const auto skipped = static_cast<std::ptrdiff_t>(begin) - (first - samples.begin());
    all.insert(all.end(), block.begin() + skipped, block.begin() + skipped + static_cast<std::ptrdiff_t>(end - begin));
  }
  return all;
}

/// One or two coordinates with common weights and bandwidths.
struct Channel {
  std::vector<std::vector<Sample>> samples;
  std::vector<std::vector<Smoothed>> smoothed;

  [[nodiscard]] std::size_t size() const { return samples.front().size(); }
  [[nodiscard]] double residual(std::size_t i) const {
    double squares = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double off = samples[k][i].value - smoothed[k][i].value;
      squares += off * off;
    }
    return std::sqrt(squares / static_cast<double>(samples.size()));
  }
  [[nodiscard]] double acceleration_square(std::size_t i) const {
    double squares = 0.0;
    for (const auto& each : smoothed) {
      squares += each[i].acceleration * each[i].acceleration;
    }
    return squares / static_cast<double>(samples.size());
  }
};

class Smoother {
 public:
  Smoother(std::vector<Channel>& channels, double step_s, double no_suspicion, double noise_share)
      : channels_(channels), step_s_(step_s), no_suspicion_(no_suspicion), noise_share_(noise_share) {}

  /// Finds the bandwidth from the share of noise: the acceleration by noise is proportional to the bandwidth to the power of 2.5.
  ChannelReport run(std::optional<double> wanted_Hz) {
    const double most_Hz = 1.0 / (kFramesPerPeriod * step_s_);
    double bandwidth_Hz = std::min(most_Hz, wanted_Hz.value_or(kFirstBandwidth_Hz));
    run_at(bandwidth_Hz);
    for (int i = 0; i < kBandwidthSearch && !wanted_Hz; ++i) {
      const double share = std::max(report_.noise_share, 1e-9);
      const double better_Hz = bandwidth_Hz * std::pow(noise_share_ / share, 0.2);
      const double next_Hz = std::min(most_Hz, std::clamp(better_Hz, kLeastBandwidth_Hz, kMostBandwidth_Hz));
      if (std::abs(next_Hz - bandwidth_Hz) < 0.02 * bandwidth_Hz) {
        break;
      }
      bandwidth_Hz = next_Hz;
      run_at(bandwidth_Hz);
    }
    return report_;
  }

 private:
  void run_at(double bandwidth_Hz) {
    report_ = {.bandwidth_Hz = bandwidth_Hz, .quiet_bandwidth_Hz = std::min(kQuietBandwidth_Hz, bandwidth_Hz)};
    for (Channel& channel : channels_) {
      for (std::vector<Sample>& each : channel.samples) {
        for (Sample& sample : each) {
          sample.bandwidth_Hz = bandwidth_Hz;
        }
      }
    }
    run_all();
    for (int i = 0; i < kReweightings; ++i) {
      estimate_noise();
      reweight();
      run_all();
    }
    energy_ = noise_energy_ = quiet_s_ = total_s_ = 0.0;
    for (Channel& channel : channels_) {
      set_bandwidths(channel);
    }
    report_.quiet_share = total_s_ > 0.0 ? quiet_s_ / total_s_ : 0.0;
    report_.noise_share = energy_ > 0.0 ? std::min(1.0, noise_energy_ / energy_) : noise_energy_ > 0.0 ? 1.0 : 0.0;
    report_.acceleration_noise_m_or_rad_per_s2 = acceleration_noise(report_.noise_m_or_rad, step_s_, bandwidth_Hz);
    run_all();
  }

  void run_all() {
    for (Channel& channel : channels_) {
      channel.smoothed.clear();
      for (const std::vector<Sample>& each : channel.samples) {
        channel.smoothed.push_back(smooth_in_blocks(each, step_s_, kMemoryPeriods / report_.quiet_bandwidth_Hz));
      }
    }
  }

  void estimate_noise() {
    std::vector<double> off;
    for (const Channel& channel : channels_) {
      for (std::size_t i = 0; i < channel.size(); ++i) {
        for (std::size_t k = 0; k < channel.samples.size(); ++k) {
          off.push_back(std::abs(channel.samples[k][i].value - channel.smoothed[k][i].value));
        }
      }
    }
    // The smoothed track follows the share 2·f·step of the noise, which is missing in the residuals.
    const double left = std::max(0.3, 1.0 - 2.0 * report_.bandwidth_Hz * step_s_);
    report_.noise_m_or_rad = kNormal * median(off) / std::sqrt(left);
  }

  void reweight() {
    report_.outliers = 0;
    const double scale = std::max(report_.noise_m_or_rad, no_suspicion_);
    for (Channel& channel : channels_) {
      for (std::size_t i = 0; i < channel.size(); ++i) {
        const double off = channel.residual(i) / scale;
        const double weight = off > kOutlier ? 0.0 : off > kHuber ? kHuber / off : 1.0;
        report_.outliers += off > kOutlier ? 1 : 0;
        for (std::vector<Sample>& each : channel.samples) {
          each[i].weight = weight;
        }
      }
    }
  }

  /// Sets the quiet bandwidth for samples whose acceleration does not exceed that of the noise.
  void set_bandwidths(Channel& channel) {
    const std::vector<Sample>& times = channel.samples.front();
    const double noise = acceleration_noise(report_.noise_m_or_rad, step_s_, report_.bandwidth_Hz);
    const double quiet_noise = acceleration_noise(report_.noise_m_or_rad, step_s_, report_.quiet_bandwidth_Hz);
    const std::size_t count = channel.size();
    std::vector<bool> active(count, false);
    double sum = 0.0;
    std::size_t first = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (; last < count && times[last].time_s <= times[i].time_s + kWindow_s; ++last) {
        sum += channel.acceleration_square(last);
      }
      for (; times[first].time_s < times[i].time_s - kWindow_s; ++first) {
        sum -= channel.acceleration_square(first);
      }
      if (sum / static_cast<double>(last - first) > kMoreThanNoise * noise * noise) {
        std::fill(active.begin() + static_cast<std::ptrdiff_t>(first), active.begin() + static_cast<std::ptrdiff_t>(last), true);
      }
    }
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const double duration_s = times[i + 1].time_s - times[i].time_s;
      const double left_behind = active[i] ? noise : quiet_noise;
      total_s_ += duration_s;
      quiet_s_ += active[i] ? 0.0 : duration_s;
      energy_ += channel.acceleration_square(i) * duration_s * (active[i] ? 1.0 : 0.0);
      noise_energy_ += left_behind * left_behind * duration_s;
    }
    for (std::vector<Sample>& each : channel.samples) {
      for (std::size_t i = 0; i < count; ++i) {
        each[i].bandwidth_Hz = active[i] ? report_.bandwidth_Hz : report_.quiet_bandwidth_Hz;
      }
    }
  }

  std::vector<Channel>& channels_;
  double step_s_;
  double no_suspicion_;  // lower bound of the noise that scales residuals, in the unit of the channels
  double noise_share_;   // target share of the noise in ∫a²
  ChannelReport report_;
  double quiet_s_ = 0.0;
  double total_s_ = 0.0;
  double energy_ = 0.0;        // ∫a² where the robot is not quiet, in the channels' unit
  double noise_energy_ = 0.0;  // expected ∫a² of the noise
};

double usual_step_s(const RobotTrack& track) {
  std::vector<double> steps_s;
  for (const TrackSegment& segment : track.segments) {
    for (std::size_t i = 1; i < segment.size(); ++i) {
      steps_s.push_back(segment[i].time_s - segment[i - 1].time_s);
    }
  }
  return median(steps_s);
}

std::vector<Channel> channels_of(const RobotTrack& track, const std::vector<double TrackPoint::*>& members) {
  std::vector<Channel> channels;
  for (const TrackSegment& segment : track.segments) {
    Channel& channel = channels.emplace_back();
    for (const auto member : members) {
      std::vector<Sample>& samples = channel.samples.emplace_back();
      samples.reserve(segment.size());
      for (const TrackPoint& point : segment) {
        samples.push_back({.time_s = point.time_s, .value = point.*member});
      }
    }
  }
  return channels;
}

/// Polynomial of fifth degree between two states.
struct Quintic {
  std::array<double, 6> c{};

  Quintic(const Smoothed& from, const Smoothed& to, double step_s) {
    const double t = step_s;
    const double p = to.value - from.value - t * (from.rate + 0.5 * t * from.acceleration);
    const double v = (to.rate - from.rate - t * from.acceleration) * t;
    const double a = (to.acceleration - from.acceleration) * t * t;
    const double t3 = t * t * t;
    c = {from.value,
         from.rate,
         0.5 * from.acceleration,
         (10.0 * p - 4.0 * v + 0.5 * a) / t3,
         (-15.0 * p + 7.0 * v - a) / (t3 * t),
         (6.0 * p - 3.0 * v + 0.5 * a) / (t3 * t * t)};
  }
  [[nodiscard]] Smoothed at(double u) const {
    return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
            c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * 5.0 * c[5]))),
            2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * 20.0 * c[5]))};
  }
};

/// Motion between two neighbouring points.
class Piece {
 public:
  Piece(const Motion& from, const Motion& to)
      : begin_s_(from.time_s),
        x_({from.x_m, from.velocity_x_m_per_s, from.acceleration_x_m_per_s2}, {to.x_m, to.velocity_x_m_per_s, to.acceleration_x_m_per_s2},
           to.time_s - from.time_s),
        y_({from.y_m, from.velocity_y_m_per_s, from.acceleration_y_m_per_s2}, {to.y_m, to.velocity_y_m_per_s, to.acceleration_y_m_per_s2},
           to.time_s - from.time_s),
        yaw_({from.yaw_rad, from.yaw_rate_rad_per_s, from.yaw_acceleration_rad_per_s2},
             {to.yaw_rad, to.yaw_rate_rad_per_s, to.yaw_acceleration_rad_per_s2}, to.time_s - from.time_s) {}

  [[nodiscard]] Motion at(double time_s) const {
    const Smoothed x = x_.at(time_s - begin_s_);
    const Smoothed y = y_.at(time_s - begin_s_);
    const Smoothed yaw = yaw_.at(time_s - begin_s_);
    return {time_s, x.value, y.value, yaw.value, x.rate, y.rate, yaw.rate, x.acceleration, y.acceleration, yaw.acceleration};
  }

 private:
  double begin_s_;
  Quintic x_;
  Quintic y_;
  Quintic yaw_;
};

std::vector<MotionTrack::Segment> together(const std::vector<Channel>& places, const std::vector<Channel>& turns) {
  std::vector<MotionTrack::Segment> segments;
  for (std::size_t s = 0; s < places.size(); ++s) {
    MotionTrack::Segment& segment = segments.emplace_back();
    segment.reserve(places[s].size());
    for (std::size_t i = 0; i < places[s].size(); ++i) {
      const Smoothed& x = places[s].smoothed[0][i];
      const Smoothed& y = places[s].smoothed[1][i];
      const Smoothed& yaw = turns[s].smoothed[0][i];
      segment.push_back({places[s].samples[0][i].time_s, x.value, y.value, yaw.value, x.rate, y.rate, yaw.rate, x.acceleration,
                         y.acceleration, yaw.acceleration});
    }
  }
  return segments;
}

}  // namespace

MotionTrack smooth(const RobotTrack& track, const SmoothingOptions& options) {
  const double step_s = usual_step_s(track);
  SmoothingReport report;
  if (!(step_s > 0.0)) {
    return {track.robot, {}, report};
  }
  report.frame_rate_Hz = 1.0 / step_s;
  std::vector<Channel> places = channels_of(track, {&TrackPoint::x_m, &TrackPoint::y_m});
  std::vector<Channel> turns = channels_of(track, {&TrackPoint::yaw_rad});
  report.place = Smoother(places, step_s, kNoSuspicion_m, kNoiseShareOfPlace).run(options.bandwidth_Hz);
  report.turn = Smoother(turns, step_s, kNoSuspicion_rad, kNoiseShareOfTurn).run(options.bandwidth_Hz);
  for (const TrackSegment& segment : track.segments) {
    report.points += segment.size();
  }
  return {track.robot, together(places, turns), report};
}

std::optional<Motion> MotionTrack::at(double time_s) const {
  const auto after = std::ranges::upper_bound(segments_, time_s, {}, [](const Segment& segment) { return segment.front().time_s; });
  if (after == segments_.begin()) {
    return std::nullopt;
  }
  const Segment& segment = *std::prev(after);
  if (time_s >= segment.back().time_s) {
    return time_s == segment.back().time_s ? std::optional(segment.back()) : std::nullopt;
  }
  const auto next = std::ranges::upper_bound(segment, time_s, {}, &Motion::time_s);
  return Piece(*std::prev(next), *next).at(time_s);
}

void MotionTrack::for_each(double rate_Hz, const std::function<void(const Motion&, std::size_t segment)>& visit) const {
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    const Segment& segment = segments_[s];
    const auto time_of = [&](std::size_t step) { return segment.front().time_s + static_cast<double>(step) / rate_Hz; };
    std::size_t step = 0;
    for (std::size_t i = 0; i + 1 < segment.size(); ++i) {
      const Piece piece(segment[i], segment[i + 1]);
      for (; time_of(step) < segment[i + 1].time_s; ++step) {
        visit(piece.at(time_of(step)), s);
      }
    }
  }
}

}  // namespace heatsoak::duty
