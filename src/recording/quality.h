// Quality of a recording, assessed before any fit.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "recording/condensed_recording.h"
#include "recording/findings.h"
#include "recording/noise.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

struct Sampling {
  double duration_s = 0.0;
  double usual_period_s = 0.0;  ///< median time between rows
  double jitter_s = 0.0;        ///< 1.4826 · median absolute deviation of the periods
  double longest_gap_s = 0.0;
};

/// Gap before a row, in which nothing is known.
struct Gap {
  int line = 0;
  double begin_s = 0.0;
  double duration_s = 0.0;
};

/// Quality of a channel. Values are in its unit.
struct ChannelQuality {
  Quantity quantity;
  std::size_t samples = 0;
  std::size_t left_out = 0;  ///< number of omitted samples, for any reason
  double low = 0.0;
  double high = 0.0;
  std::size_t at_low = 0;  ///< samples of exactly this value
  std::size_t at_high = 0;
  std::size_t distinct = 0;  ///< number of distinct values; in long logs, of some ten thousand samples
  double step = 0.0;         ///< resolution; 0 if no quantisation is visible
  double noise = 0.0;        ///< standard deviation, model-free, not below step/√12
  [[nodiscard]] bool is_constant() const { return !(high > low); }
};

/// Delay of a temperature relative to the heat input. A clock offset and a sensor lag are indistinguishable.
struct ClockOffset {
  std::string temperature;
  std::string heat_input;
  std::optional<double> delay_s;         ///< positive: the temperature is late; nullopt if not determined
  double delay_uncertainty_s = 0.0;      ///< standard error; includes a jackknife over eighths of the log
  double misfit_ratio = 1.0;             ///< sum of squared errors without delay divided by that with delay
  std::optional<NoDelayReason> why_not;  ///< set if delay_s is not
  bool explains_flow = false;            ///< true: the log has other temperatures, and this one is the hottest while heated
};

/// Suitability of a log for one purpose.
struct Fitness {
  std::vector<Lack> lacks;  ///< empty if suitable
  [[nodiscard]] bool is_good() const { return lacks.empty(); }
};

struct DataQuality {
  static constexpr std::size_t kMostGaps = 1000;
  Sampling sampling;
  std::size_t runs = 0;
  std::vector<Gap> gaps;  ///< between runs, the first kMostGaps
  std::vector<ChannelQuality> channels;
  std::vector<ClockOffset> clock_offsets;
  std::vector<Suspicion> suspicions;           ///< reported only, nothing is corrected
  std::vector<Suspicion> blocking;             ///< subset about units, signs and sensors that, if true, prevents any fit
  std::vector<Suspicion> blocking_for_wheels;  ///< subset about the robot's wheels, its angles and the clock that prevents a friction fit
  Fitness thermal;                             ///< for fitting a thermal network
  Fitness drive;                               ///< for fitting friction of wheels
};

/// Assesses a log part by part with bounded memory.
class Assessment {
 public:
  /// Adds the next part, as returned by RecordingStream.
  void add(const Recording& part);
  /// Returns the result after the last part. Channels without samples are not listed. `ambient_C`: air temperature if the
  /// user states it.
  DataQuality conclude(const RecordingReport& report, std::optional<double> ambient_C = {});
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
  void report_channels(const RecordingReport& report);

  CondensedRecording condensed_;
  std::vector<Gauge> gauges_;  ///< per channel
  Thinned steps_s_;
  std::size_t rows_ = 0;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  DataQuality quality_;
};

DataQuality assess(const Recording& recording, const RecordingReport& report, std::optional<double> ambient_C = {});

/// Logs contain no information about heat (cannot_answer), because they lack data.
class NothingAboutHeat : public base::Failure {
 public:
  struct Log {
    std::filesystem::path file;
    std::vector<Lack> lacks;
  };
  explicit NothingAboutHeat(std::vector<Log> logs);
  [[nodiscard]] const std::vector<Log>& logs() const { return logs_; }

 private:
  std::vector<Log> logs_;
};

/// Logs share rows, so that a run would count twice (bad_input).
class RowsGivenTwice : public base::Failure {
 public:
  /// Lines of a file, from 1.
  struct Lines {
    int first = 1;
    int last = 1;
  };
  /// Rows of a log.
  struct Rows {
    explicit Rows(const Recording& recording);
    Rows(std::filesystem::path of_file, Lines of_rows) : file(std::move(of_file)), lines(of_rows) {}

    std::filesystem::path file;
    std::optional<Lines> lines;  ///< empty for a recording that was not read from a file
  };
  struct Pair {
    Rows rows;
    Rows earlier;  ///< same rows of an earlier log
  };
  explicit RowsGivenTwice(std::vector<Pair> pairs);
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  std::vector<Pair> pairs_;
};

/// Returns the first channel of kHeatColumns that varies, the one that heats the winding most directly; nullptr if none varies. Checks
/// compare temperatures with it. The heat of a model is another choice: calibration::heat_input_of().
const Channel* most_direct_heat_input(const Recording& recording);

/// Returns the heat per row up to a factor: the channel itself if it is a power, else its square. NaN if not known.
std::vector<double> relative_heat(const Channel& heat_input);

}  // namespace heatsoak::recording
