// Evaluates motors on a duty with all declared uncertainties and ranks them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::select {

/// Verdict on a motor. verdict_meanings() in present/verdict_topic.h explains each value.
enum class Verdict { pass, marginal, fail, infeasible };
enum class LimitingFactor { none, winding_temperature, stator_temperature, voltage, current };
std::string_view to_string(Verdict verdict);
/// Returns the verdict of a nominal run, or marginal if it passes but `upper`, the same run with motor::at_upper_band(), does not.
Verdict with_upper(Verdict nominal, Verdict upper);
std::string_view to_string(LimitingFactor factor);

/// A passing motor becomes marginal if the probability of exceeding a limit, or of missing the demand, is larger than this.
inline constexpr double kMarginalProbability = 0.05;
/// On a duty with draws a motor fails if a larger share of the samples exceeds a limit, and is infeasible if a larger share misses the
/// demand.
inline constexpr double kMajority = 0.5;
/// The demand counts as met if it is missed for at most this share of the time.
inline constexpr double kTolerableShortTime = 0.01;

struct EvaluateOptions {
  int samples = 500;  ///< 0: nominal only
  std::uint64_t seed = 1;
  int threads = 0;                  ///< 0: all cores; the result does not depend on it
  bool with_curves = false;         ///< keep the nominal temperatures over time
  bool with_bands = false;          ///< keep the range of the samples over time; needs with_curves
  bool with_current_margin = true;  ///< compute margin_A; adds a quarter to the time of a nominal run
  /// Demands of the most loaded wheel for draws of the duty's unknown parameters. Blocks of samples use them in turn. If empty, all samples
  /// have the nominal demand.
  std::span<const duty::WheelDemand> draws{};
};

/// Nominal value, and 5th, 50th and 95th percentile of the samples; percentiles are empty without samples.
struct Spread95 {
  double nominal = 0.0;
  std::optional<double> p05 = {};
  std::optional<double> p50 = {};
  std::optional<double> p95 = {};
};

/// 95 % confidence interval of a statistic of the samples.
struct Interval95 {
  double low = 0.0;
  double high = 0.0;
};

struct TemperatureCurves {
  std::vector<double> time_s;  ///< steps of the solver in the nominal run
  std::vector<double> winding_C;
  std::vector<double> stator_C;
  std::vector<double> band_time_s;  ///< centres of the time cells of the bands
  std::vector<double> winding_p05_C, winding_p95_C;
  std::vector<double> stator_p05_C, stator_p95_C;
};

struct MotorEvaluation {
  std::string motor_id;
  std::string wheel;  ///< wheel with the hottest winding in the nominal run; all values refer to it
  Verdict verdict = Verdict::pass;
  LimitingFactor limiting_factor = LimitingFactor::none;
  std::string data_quality;
  double winding_limit_C = 0.0;
  std::optional<double> stator_limit_C;
  Spread95 winding_peak_C;
  Spread95 stator_peak_C;
  int samples = 0;  ///< number of samples; 0: nominal only
  int games = 0;    ///< number of draws that the samples share; 0 for a duty without draws
  /// Number of samples that would decide the verdict, from samples_needed() in select/decision.h; empty if it is decided.
  std::optional<int> samples_needed;
  std::optional<double> probability_over_limit = {};  ///< share of samples over any temperature limit; empty without samples
  /// Confidence intervals of the 95th percentiles and of the probability, for repeated samples or, on a duty with draws, repeated draws.
  /// The interval of the probability holds for all looks of error_share() in select/decision.h together. Empty without samples.
  std::optional<Interval95> winding_p95_interval_C;
  std::optional<Interval95> stator_p95_interval_C;
  std::optional<Interval95> probability_interval;
  std::optional<double> time_to_limit_s;  ///< time in the nominal run until the first limit is exceeded; empty if none is
  double current_rms_A = 0.0;             ///< RMS of the heating current over the duty
  double margin_K = 0.0;                  ///< winding limit minus nominal peak
  std::optional<double> stator_margin_K;  ///< stator limit minus nominal peak; empty without stator limit
  /// Additional RMS current at the same speeds until the first node reaches its limit, bounded by voltage and driver; negative if a limit
  /// is exceeded. Empty if no current reaches a limit or even zero current exceeds one, and without with_current_margin.
  std::optional<double> margin_A;
  double least_torque_share = 1.0;  ///< smallest ratio of delivered to demanded current
  /// Share of the time in which the demand is not met, with the winding at its peak temperature, or at its limit if that is lower.
  double short_time_share = 0.0;
  LimitingFactor short_limit = LimitingFactor::voltage;  ///< limit that causes the shortfall, if there is one
  /// Share of samples that miss the demand for longer than kTolerableShortTime; empty without samples.
  std::optional<double> short_probability = {};
  std::optional<Interval95> short_interval;  ///< confidence interval of short_probability, like probability_interval
  double highest_voltage_V = 0.0;            ///< largest demanded voltage at the terminals with the hot winding
  bool destroyed = false;                    ///< thermal runaway: the nominal run ended at 1000 °C
  TemperatureCurves curves;
};

/// Returns the number of draws for `samples` samples: one for every eight, or 0 for a duty without unknown parameters. Playing a game takes
/// about a hundred times as long as evaluating eight samples of it.
int draw_count(const duty::Duty& duty, int samples);

/// Returns the demand of the most loaded wheel for each draw. The result does not depend on `threads`.
std::vector<duty::WheelDemand> draw_demands(const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count, int threads,
                                            const base::Progress& progress = {});

/// Appends draws to `draws` until there are `count`, as draw_demands() would compute them.
void add_draws(std::vector<duty::WheelDemand>& draws, const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count,
               int threads, const base::Progress& progress = {});

/// Returns the margin to the nearer temperature limit in K; negative if a limit is exceeded. It is that of the nominal peak, or on a duty
/// with draws, whose nominal run is one of many games, that of the 95th percentile.
double nearest_margin_K(const MotorEvaluation& motor);

/// Sorts by verdict (pass, marginal, fail, infeasible), then by nearest_margin_K(), the largest first.
void sort_by_verdict(std::vector<MotorEvaluation>& results);

/// Returns one evaluation per motor, sorted by sort_by_verdict(). `wheels` is the nominal demand of the duty; the wheel with the hottest
/// winding is evaluated. Without draws the nominal run decides fail and infeasible; with draws it is one of many games, and kMajority of
/// the samples decides. Motor values without a spread get a default one (motor/default_spread.h). `progress` is called from one thread at a
/// time.
std::vector<MotorEvaluation> evaluate(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                                      std::span<const motor::Motor> motors, const EvaluateOptions& options,
                                      const base::Progress& progress = {});

/// Evaluates as evaluate() does, but uses the spreads of the motor files unchanged, even if they are missing or implausibly narrow. For
/// comparisons only, not for verdicts.
std::vector<MotorEvaluation> evaluate_as_stated(const robot::Robot& robot, const duty::Duty& duty,
                                                std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                const EvaluateOptions& options, const base::Progress& progress = {});

}  // namespace heatsoak::select
