// Draws, intervals and files from which a threshold's value was computed, as data. src/present makes the words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "derate/committed_table.h"
#include "motor/lint.h"
#include "select/spread.h"

namespace heatsoak::check {

/// One-sided confidence of the bounds that thresholds compare: that of the worse end of a 95 % interval, in every threshold.
inline constexpr double kBoundConfidence_share = select::kBoundConfidence_share;

/// 95th percentile of a peak over the samples. The threshold compares its bound.
struct PeakBasis {
  double p95_C = 0.0;
  double bound_C = 0.0;  ///< upper confidence bound
  double nominal_C = 0.0;
  double median_C = 0.0;
  int samples = 0;
  std::string wheel;
};

/// Share of samples over a limit. The threshold compares its confidence bound.
struct ShareBasis {
  long over = 0;
  int samples = 0;
  std::optional<int> games;  ///< games, if the duty is drawn: samples of one game count as one draw
  double limit_share = 0.0;
  std::optional<long> samples_needed;  ///< samples with which this share could meet the limit; empty if no number suffices
};

struct MarginBasis {
  double current_rms_A = 0.0;  ///< current of the nominal motor in the duty
};

/// Place where a committed table allows most more than a fresh one.
struct ExcessBasis {
  derate::TablePlace excess;
  double lost_A = 0.0;             ///< largest deficit elsewhere
  std::string other_version = {};  ///< derate::TableComparison::other_version
};

/// Place where a committed table allows most less than a fresh one.
struct LostBasis {
  derate::TablePlace lost;
  std::string other_version = {};  ///< derate::TableComparison::other_version
};

struct TimeAboveBasis {
  double temperature_C = 0.0;
  double duration_s = 0.0;
  double nominal_peak_C = 0.0;
};

struct GuardShareBasis {
  double limited_s = 0.0;
  double duration_s = 0.0;
  double observer_peak_C = 0.0;
  double winding_peak_C = 0.0;
};

struct GuardChargeBasis {
  double limited_s = 0.0;
  double duration_s = 0.0;
};

struct LintBasis {
  motor::LintFinding first;
};

struct RankBasis {
  std::size_t motors = 0;
  std::vector<std::string> better;  ///< ids of the motors before it
};

struct CoreSizeBasis {
  std::size_t files = 0;
  std::size_t table_bytes = 0;
};

struct ForecastBasis {
  struct Signal {
    std::string run;
    std::string signal;
    double rmse_K = 0.0;
    double largest_K = 0.0;
  };
  std::vector<Signal> signals;
};

/// An end that the answer gives as null is unbounded.
struct AnswerInterval {
  std::optional<double> low;
  std::optional<double> high;
};

/// Part of a number that the limit is compared with.
enum class Compared {
  number,        ///< the number, which is exact
  interval,      ///< the worse end of its 95 % interval
  percentile,    ///< the number, although it is a percentile: the answer has no interval for it
  probability,   ///< the probability: the answer has no interval for it
  nominal_time,  ///< the time of the nominal motor
  nominal        ///< the value of the nominal motor
};

/// Number of a command's answer.
struct NumberBasis {
  std::string name;         ///< its place in the answer
  std::size_t numbers = 1;  ///< numbers that the limit names; this one is the nearest to violating it
  Compared compared = Compared::number;
  double value = 0.0;
  AnswerInterval interval;  ///< only with Compared::interval
};

/// Nothing if the value needs no explanation.
using Basis = std::variant<std::monostate, PeakBasis, ShareBasis, MarginBasis, ExcessBasis, LostBasis, TimeAboveBasis, GuardShareBasis,
                           GuardChargeBasis, LintBasis, RankBasis, CoreSizeBasis, ForecastBasis, NumberBasis>;

}  // namespace heatsoak::check
