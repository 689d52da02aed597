// What a recording is worth, told before anything is fitted to it.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identify/measurement/condensed_recording.h"
#include "identify/measurement/noise.h"
#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"

namespace heatsoak {

struct Sampling {
  double duration_s = 0.0;
  double usual_period_s = 0.0;  ///< median
  double jitter_s = 0.0;        ///< 1.4826 · median deviation of the periods
  double longest_gap_s = 0.0;
};

/// Before a row: between it and the one before nothing is known.
struct Gap {
  int line = 0;
  double begin_s = 0.0;
  double duration_s = 0.0;
};

/// In the channel's unit where no other is named.
struct ChannelQuality {
  Quantity quantity;
  std::size_t samples = 0;
  std::size_t left_out = 0;  ///< for whatever reason
  double low = 0.0;
  double high = 0.0;
  std::size_t at_low = 0;  ///< samples of exactly this value
  std::size_t at_high = 0;
  std::size_t distinct = 0;  ///< different values, of long logs among some ten thousand samples
  double step = 0.0;         ///< resolution; 0 where none is seen
  double noise = 0.0;        ///< standard deviation, model-free, not below step/√12
  [[nodiscard]] bool is_constant() const { return !(high > low); }
};

/// Whether a temperature follows the heat input at once. A clock offset and a sensor's lag look alike.
struct ClockOffset {
  std::string temperature;
  std::string heat_input;
  std::optional<double> delay_s;     ///< positive: the temperature comes late; nothing where it cannot be told
  double delay_uncertainty_s = 0.0;  ///< standard error, by leaving out one eighth of the log after the other
  double misfit_ratio = 1.0;         ///< squared errors without any delay over those with it
  std::string why_not;               ///< where it cannot be told
  bool explains_flow = false;        ///< what the first temperature gives away is known, and heat makes it hotter than all beside it
};

/// What a log is good for, or what it lacks.
struct Fitness {
  std::vector<std::string> lacks;  ///< in sentences; empty: good
  [[nodiscard]] bool is_good() const { return lacks.empty(); }
};

struct DataQuality {
  static constexpr std::size_t kMostGaps = 1000;
  Sampling sampling;
  std::size_t runs = 0;
  std::vector<Gap> gaps;  ///< between runs, the first kMostGaps
  std::vector<ChannelQuality> channels;
  std::vector<ClockOffset> clock_offsets;
  std::vector<std::string> suspicions;       ///< said, not acted on
  std::vector<std::string> spoiling;         ///< of them: units, signs and sensors with which nothing can be fitted, were it so
  std::vector<std::string> spoiling_wheels;  ///< the same of a robot's wheels and angles, and of the clock
  Fitness thermal;                           ///< to fit a thermal network
  Fitness drive;                             ///< to fit friction of wheels
};

/// Takes a log part by part; what it keeps does not grow with the log.
class Assessment {
 public:
  static constexpr double kNotStated_C = std::numeric_limits<double>::quiet_NaN();

  /// As RecordingStream gives them.
  void add(const Recording& part);
  /// After the last part. Channels without one sample are not told of. `ambient_C`: of the air as the user states it, NaN where not.
  DataQuality conclude(const RecordingReport& report, double ambient_C = kNotStated_C);
  [[nodiscard]] const CondensedRecording& condensed() const { return condensed_; }

 private:
  struct Gauge {
    NoiseGauge noise;
    std::size_t samples = 0;
    std::size_t at_low = 0;
    std::size_t at_high = 0;
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void add(std::span<const double> values);
  };
  void add_times(const Recording& part);
  void tell_channels(const RecordingReport& report);

  CondensedRecording condensed_;
  std::vector<Gauge> gauges_;  ///< per channel
  Thinned steps_s_;
  std::size_t rows_ = 0;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  DataQuality quality_;
};

DataQuality assess(const Recording& recording, const RecordingReport& report, double ambient_C = Assessment::kNotStated_C);

/// Throws Failure (cannot_answer) where the recording cannot tell anything about a thermal network: too short, nothing
/// changes, no temperature or no heat input.
void require_thermal(const Recording& recording, const DataQuality& quality);

/// The channel that tells best how much heat goes in: power, or else current, torque, voltage, speed; null where none varies.
const Channel* heat_input_of(const Recording& recording);

/// Heat per row, up to a factor: the channel itself where it is a power, else its square. NaN where it is not known.
std::vector<double> relative_heat(const Channel& heat_input);

}  // namespace heatsoak
