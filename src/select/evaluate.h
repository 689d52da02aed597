// Does the motor survive the duty? Ranks candidates with every declared uncertainty.
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

/// What each one means stands in verdict_meanings() of present/verdict_topic.h, in words made from the constants below.
enum class Verdict { pass, marginal, fail, infeasible };
enum class LimitingFactor { none, winding_temperature, stator_temperature, voltage, current };
std::string_view to_string(Verdict verdict);
std::string_view to_string(LimitingFactor factor);

/// A motor that would pass is marginal if samples exceed a limit, or miss the demand, with more than this probability.
inline constexpr double kMarginalProbability = 0.05;
/// On a duty with draws of its own a motor fails, or is infeasible, if more than this share of the samples says so.
inline constexpr double kMajority = 0.5;
/// A demand counts as met where it is missed for no larger part of the time: a lost centimetre, not a lost match.
inline constexpr double kTolerableShortTime = 0.01;

struct EvaluateOptions {
  int samples = 500;  ///< 0: nominal only
  std::uint64_t seed = 1;
  int threads = 0;                  ///< 0: all cores; the result does not depend on it
  bool with_curves = false;         ///< keep the nominal temperatures over time
  bool with_bands = false;          ///< keep the range of the samples over time too; asks for with_curves
  bool with_current_margin = true;  ///< find margin_A, which takes a quarter of the time of a nominal run
  /// Demands of the hardest wheel under draws of the duty's own unknowns, which blocks of samples take in turn; empty: all
  /// samples have the nominal demand.
  std::span<const duty::WheelDemand> draws{};
};

/// The parameter without uncertainty and the 5th, 50th and 95th percentile of the samples (NaN without samples).
struct Spread95 {
  double nominal = 0.0;
  double p05 = 0.0;
  double p50 = 0.0;
  double p95 = 0.0;
};

/// What another set of draws of the duty would give in its place, 19 times of 20.
struct Interval95 {
  double low = 0.0;
  double high = 0.0;
};

struct TemperatureCurves {
  std::vector<double> time_s;  ///< of the nominal run, every step of the solver
  std::vector<double> winding_C;
  std::vector<double> stator_C;
  std::vector<double> band_time_s;  ///< middles of the cells in which the samples' lowest and highest are taken
  std::vector<double> winding_p05_C, winding_p95_C;
  std::vector<double> stator_p05_C, stator_p95_C;
};

struct MotorEvaluation {
  std::string motor_id;
  std::string wheel;  ///< the hottest one, which all temperatures are of
  Verdict verdict = Verdict::pass;
  LimitingFactor limiting_factor = LimitingFactor::none;
  std::string data_quality;
  double winding_limit_C = 0.0;
  std::optional<double> stator_limit_C;
  Spread95 winding_peak_C;
  Spread95 stator_peak_C;
  int samples = 0;  ///< that this answer rests on
  int games = 0;    ///< draws of the duty that the samples share; 0 where it has none
  /// Samples that would decide the verdict, as samples_needed() in select/decision.h; nothing where it is decided.
  std::optional<int> samples_needed;
  double probability_over_limit = 0.0;  ///< of any temperature limit; NaN without samples
  /// Of the 95th percentile and of the probability: what other samples would give or, where a duty is drawn, other draws. The probability's
  /// holds at every look of error_share() in select/decision.h at once. Nothing without samples.
  std::optional<Interval95> winding_p95_interval_C;
  std::optional<Interval95> stator_p95_interval_C;
  std::optional<Interval95> probability_interval;
  std::optional<double> time_to_limit_s;  ///< nominal, first of the limits
  double current_rms_A = 0.0;             ///< heating current over the whole duty
  double margin_K = 0.0;                  ///< winding limit minus nominal peak
  std::optional<double> stator_margin_K;  ///< the same of the stator, where it has a limit
  std::optional<double> margin_A;   ///< how much more rms current both bear at the same speeds, as far as voltage and driver let it through
  double least_torque_share = 1.0;  ///< delivered over demanded, worst moment
  double short_time_share = 0.0;    ///< part of the time in which the demand is not met, hot but within the limit
  LimitingFactor short_limit = LimitingFactor::voltage;  ///< what cuts the current first, if anything does
  double short_probability = 0.0;  ///< samples that miss the demand for more than kTolerableShortTime; NaN without samples
  double highest_voltage_V = 0.0;  ///< needed at the terminals, hot
  bool destroyed = false;          ///< runaway: the nominal run ended at 1000 °C
  TemperatureCurves curves;
};

/// How many draws of a duty's unknowns serve `samples`: one for every eight, because playing a game takes some hundred times as long as
/// evaluating eight samples of it. 0 for a duty without unknowns.
int draw_count(const duty::Duty& duty, int samples);

/// Of each draw the wheel that works hardest. The same for every number of threads.
std::vector<duty::WheelDemand> draw_demands(const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count, int threads,
                                            const base::Progress& progress = {});

/// The same for draws draws.size() to count - 1, added at the end.
void add_draws(std::vector<duty::WheelDemand>& draws, const duty::Duty& duty, const robot::Robot& robot, std::uint64_t seed, int count,
               int threads, const base::Progress& progress = {});

/// To the limit that is nearer.
double nearest_margin_K(const MotorEvaluation& motor);

/// Best first: pass, marginal, fail, infeasible; within them by margin.
void sort_by_verdict(std::vector<MotorEvaluation>& results);

/// Sorted by sort_by_verdict(). Without draws the nominal parameters decide fail and
/// infeasible; with draws, where the nominal run is one of many games, more than half of the samples do. `wheels` is the duty's demand;
/// every parameter is of the wheel whose winding gets hottest. Values of a motor without a spread are drawn from a default one
/// (motor/default_spread.h), never as exact. `progress` is called from one thread at a time.
std::vector<MotorEvaluation> evaluate(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                                      std::span<const motor::Motor> motors, const EvaluateOptions& options,
                                      const base::Progress& progress = {});

/// The same with the spreads that the motors have, be they missing or narrower than anybody can know: for comparisons, not for verdicts.
std::vector<MotorEvaluation> evaluate_as_stated(const robot::Robot& robot, const duty::Duty& duty,
                                                std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                const EvaluateOptions& options, const base::Progress& progress = {});

}  // namespace heatsoak::select
