#include <fmt/format.h>

#include <algorithm>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/export_text.h"

namespace heatsoak::derate::c_header {
namespace {

constexpr std::string_view kStructures = R"(typedef enum {
  @_sensor_used,       /* the reading corrects the observer */
  @_sensor_silent,     /* no reading or an implausible one: after @CAP@_SENSOR_HOLD_S the guard acts as without a sensor */
  @_sensor_jumped,     /* changed faster than the motor can; dropped permanently after @CAP@_SENSOR_CONTRADICTION_S of this */
  @_sensor_too_cold,   /* dropped permanently: colder than the coldest motor under this load */
  @_sensor_frozen      /* dropped permanently: did not change although the motor must have */
} @_sensor_status;

typedef struct {
  uint32_t started;
  @_state model;                /* guard without the sensor, driven by the measured current */
  float state_C[@NODES@];             /* corrected by the sensor; safety factor on heat @RESERVE@ while it is used */
  float carry_K[@NODES@];
  float capped_C[@NODES@];            /* guard without the sensor, driven by at most the current that it would have allowed and the excess over allowed_A */
  float capped_carry_K[@NODES@];
  float capped_A;
  float allowed_A;              /* current that the last step allowed */
  float lag_C;                  /* temperature of the sensor itself */
  float last_C;                 /* last plausible reading */
  float unread_s;               /* time since a reading was used */
  float sensed_share;           /* 0: current without the sensor, 1: with it */
  float gap_s;                  /* time since a plausible reading */
  float jumped_s;               /* time for which the readings have contradicted the motor */
  float cold_s;
  float frozen_C;
  float frozen_nominal_C;
  uint32_t rejected;            /* readings that were not used */
  @_sensor_status dropped;      /* reason why the sensor was dropped, else @_sensor_used */
} @_sensed_state;

typedef struct {
  @_output guard;
  float model_only_A;     /* A, current that the guard without the sensor would allow after the same load, counted up to what it allowed.
                             guard.allowed_current_A is at most this plus @CAP@_SENSOR_MOST_GAIN_A and 1e-6 A of rounding */
  @_sensor_status sensor;
} @_sensed_output;

/* Begins with the temperatures of the guard without the sensor. */
static inline void @_begin_sensed(@_sensed_state *state) {
  int node;
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = state->model.state_C[node];
    state->capped_C[node] = state->model.state_C[node];
    state->carry_K[node] = 0.0f;
    state->capped_carry_K[node] = 0.0f;
  }
  state->capped_A = 0.0f;
  state->allowed_A = 0.0f;
  state->lag_C = state->model.state_C[0];
  state->last_C = state->model.state_C[0];
  state->frozen_C = state->model.state_C[0];
  state->frozen_nominal_C = state->model.state_C[0];
  state->unread_s = @CAP@_SENSOR_HOLD_S;
  state->sensed_share = 0.0f;
  state->gap_s = 1e6f;
  state->jumped_s = 0.0f;
  state->cold_s = 0.0f;
  state->rejected = 0u;
  state->dropped = @_sensor_used;
  state->started = @CAP@_STARTED;
}

/* As @_start. A dropped sensor is used again. */
static inline void @_sensed_start(@_sensed_state *state, float body_C) {
  @_start(&state->model, body_C);
  @_begin_sensed(state);
}

/* As @_save and @_restore, which keep the guard without the sensor:
   it is at least as hot as the motor. A dropped sensor is used again. */
static inline void @_sensed_save(const @_sensed_state *state, uint8_t *buffer) {
  @_save(&state->model, buffer);
}

static inline @_restored_from @_sensed_restore(@_sensed_state *state, const uint8_t *buffer, float elapsed_s, float unsaved_s, float board_C) {
  const @_restored_from from = @_restore(&state->model, buffer, elapsed_s, unsaved_s, board_C);
  @_begin_sensed(state);
  return from;
}

)";

constexpr std::string_view kCheck =
    R"(/* Checks whether the motor can have this temperature. Hottest air may mean not measured: then the coldest air is assumed. */
static inline @_sensor_status @_check_reading(@_sensed_state *state, float reading_C, float ambient_C) {
  const float air_C = ambient_C < @CAP@_HOTTEST_AMBIENT_C ? ambient_C : @CAP@_COLDEST_AMBIENT_C;
  const float nominal_C = state->model.nominal_C[@SENSOR_NODE@];
  float change_K;
  float swing_K;
  state->gap_s += @CAP@_PERIOD_S;
  if (!@_is_between(@CAP@_COLDEST_AMBIENT_C - @CAP@_SENSOR_ACCURACY_K, reading_C, @CAP@_SENSOR_MOST_C)) {
    return @_sensor_silent;
  }
  change_K = reading_C < state->last_C ? state->last_C - reading_C : reading_C - state->last_C;
  if (change_K > @CAP@_SENSOR_MOST_JUMP_K + @CAP@_SENSOR_MOST_RATE_K_PER_S * state->gap_s) {
    state->jumped_s += @CAP@_PERIOD_S;
    state->dropped = state->jumped_s > @CAP@_SENSOR_CONTRADICTION_S ? @_sensor_jumped : state->dropped;
    return @_sensor_jumped;
  }
  if (reading_C + @CAP@_SENSOR_ACCURACY_K + @CAP@_SENSOR_COLD_MARGIN_K - air_C < @CAP@_SENSOR_COLD_RATIO * (nominal_C - ambient_C)) {
    state->cold_s += @CAP@_PERIOD_S;
    state->dropped = state->cold_s >= @CAP@_SENSOR_CONTRADICTION_S ? @_sensor_too_cold : state->dropped;
  } else {
    state->cold_s = state->cold_s > 0.25f * @CAP@_PERIOD_S ? state->cold_s - 0.25f * @CAP@_PERIOD_S : 0.0f;
  }
  change_K = reading_C < state->frozen_C ? state->frozen_C - reading_C : reading_C - state->frozen_C;
  swing_K = nominal_C < state->frozen_nominal_C ? state->frozen_nominal_C - nominal_C : nominal_C - state->frozen_nominal_C;
  if (change_K > @CAP@_SENSOR_FROZEN_BAND_K || state->gap_s > @CAP@_SENSOR_HOLD_S) {
    state->frozen_C = reading_C;
    state->frozen_nominal_C = nominal_C;
  }
  if (change_K <= @CAP@_SENSOR_FROZEN_BAND_K && state->gap_s <= @CAP@_SENSOR_HOLD_S && swing_K > @CAP@_SENSOR_FROZEN_K + (ambient_C - air_C)) {
    state->dropped = @_sensor_frozen;
  }
  state->last_C = reading_C;
  state->gap_s = 0.0f;
  state->jumped_s = 0.0f;
  return state->dropped;
}

@HOTTEST_BODY@/* Corrects the observer with the upper bound of the reading. */
static inline void @_correct(@_sensed_state *state, float reading_C) {
  const float gain[@NODES@] = {@GAINS@};
  const float innovation_K = reading_C + @CAP@_SENSOR_ACCURACY_K - @PREDICTED@;
  int node;
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = @_bounded_C(state->state_C[node] + gain[node] * innovation_K);
  }
@CORRECT_LAG@}

)";

constexpr std::string_view kSensedStep =
    R"(/* Resets to the guard without the sensor: after a restart, with an unknown input, and once the sensor is dropped. */
static inline void @_forget_sensor(@_sensed_state *state, float allowed_A) {
  int node;
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = state->model.state_C[node];
    state->capped_C[node] = state->model.state_C[node];
    state->carry_K[node] = 0.0f;
    state->capped_carry_K[node] = 0.0f;
  }
  state->capped_A = allowed_A;
  state->allowed_A = allowed_A;
  state->lag_C = state->model.state_C[@SENSOR_NODE@];
  state->unread_s = @CAP@_SENSOR_HOLD_S;
  state->sensed_share = 0.0f;
}

static inline bool @_is_sensed_started(const @_sensed_state *state) {
  int node;
  bool is_started = state->started == @CAP@_STARTED && @_is_temperature(state->lag_C) &&
                    @_is_between(0.0f, state->capped_A, @CAP@_MOST_CURRENT_A) &&
                    @_is_between(0.0f, state->allowed_A, @CAP@_MOST_CURRENT_A) &&
                    @_is_between(0.0f, state->unread_s, 2.0f * @CAP@_SENSOR_HOLD_S) && @_is_between(0.0f, state->gap_s, 2e6f) &&
                    @_is_between(0.0f, state->sensed_share, 1.0f) &&
                    @_is_between(0.0f, state->jumped_s, 2.0f * @CAP@_SENSOR_CONTRADICTION_S) &&
                    @_is_between(0.0f, state->cold_s, 2.0f * @CAP@_SENSOR_CONTRADICTION_S);
  for (node = 0; node < @NODES@; ++node) {
    is_started = is_started && @_is_temperature(state->state_C[node]) && @_is_temperature(state->capped_C[node]);
    is_started = is_started && @_is_between(-1.0f, state->carry_K[node], 1.0f);
    is_started = is_started && @_is_between(-1.0f, state->capped_carry_K[node], 1.0f);
  }
  return is_started;
}

/* Returns true if more current flowed than the guard had allowed, by more than the ripple of a current control: then every observer counts
   all of it. */
static inline bool @_is_over_allowed(const @_sensed_state *state, float current_A) {
  const float size_A = current_A < 0.0f ? -current_A : current_A;
  return size_A > @CAP@_SENSOR_RIPPLE_RATIO * state->allowed_A;
}

/* A correct sensor keeps the winding within its limit while the current is that allowed, so the guard without the sensor is capped at that
   limit, or at its last temperature if that is higher. */
static inline void @_cap_model(@_sensed_state *state, const float *last_C) {
  int node;
  for (node = 0; node < @NODES@; ++node) {
    const float most_C = last_C[node] > @CAP@_WINDING_LIMIT_C ? last_C[node] : @CAP@_WINDING_LIMIT_C;
    if (state->model.state_C[node] > most_C) {
      state->model.state_C[node] = most_C;
      state->model.carry_K[node] = 0.0f;
    }
  }
}

/* One period of both observers. The capped one counts the current up to that which it would have allowed, and what flowed
   beyond the allowed current: the two currents then never differ by more than the sensor may add. */
static inline void @_advance_sensed(@_sensed_state *state, const @_input *measured, bool is_over) {
  @_input capped = *measured;
  float rate_K_per_s[@NODES@];
  if (!is_over) {
    const float size_A = capped.current_A < 0.0f ? -capped.current_A : capped.current_A;
    const float most_A = state->capped_A + (size_A > state->allowed_A ? size_A - state->allowed_A : 0.0f);
    capped.current_A = capped.current_A < most_A ? capped.current_A : most_A;
    capped.current_A = capped.current_A > -most_A ? capped.current_A : -most_A;
  }
  @_rates(&capped, state->capped_C, rate_K_per_s);
  @_advance(state->capped_C, state->capped_carry_K, rate_K_per_s);
  if (state->unread_s < @CAP@_SENSOR_HOLD_S) {
    @_sensed_rates(measured, state->state_C, rate_K_per_s);
  } else {
    @_rates(measured, state->state_C, rate_K_per_s);
  }
  @_advance(state->state_C, state->carry_K, rate_K_per_s);
@ADVANCE_LAG@}

/* Moves between the currents with and without the sensor, so that a gap in the readings causes no step: down from half of
   @CAP@_SENSOR_HOLD_S without a reading on, up within @CAP@_SENSOR_HOLD_S. Never above the current that holds at this time: a motor so cold
   that it gets less with the sensor falls to that at once when readings return. */
static inline float @_current_with_sensor_A(@_sensed_state *state, float speed_rad_per_s) {
  const float hottest_C = @_hottest_body_C(state->state_C);
  const float sensed_A = @_sensed_allowed_A(speed_rad_per_s, hottest_C, state->state_C[0]);
  const float without_A = @_allowed_A(speed_rad_per_s, hottest_C, state->state_C[0]);
  const float step = @CAP@_PERIOD_S / @CAP@_SENSOR_HOLD_S;
  const bool is_read = state->unread_s < @CAP@_SENSOR_HOLD_S;
  float share = is_read ? state->sensed_share + step : state->sensed_share - step;
  float most_share = 1.0f;
  if (sensed_A >= without_A) {
    most_share = is_read ? 2.0f - 2.0f * state->unread_s / @CAP@_SENSOR_HOLD_S : 0.0f;
    most_share = most_share < 1.0f ? most_share : 1.0f;
  }
  share = share < most_share ? share : most_share;
  state->sensed_share = share > 0.0f ? share : 0.0f;
  return is_read && sensed_A < without_A ? sensed_A : without_A + state->sensed_share * (sensed_A - without_A);
}

/* Replaces @_step. reading_C: reading of the sensor; NAN if there is none in this period.
   Once the sensor is dropped or an input is unknown, the current falls to that of @_step at once.
   Measure ambient_C: without it (the hottest declared air) a sensor that fell off, or is stuck near ambient_C, is not dropped. The motor may then exceed its limit; SENSOR_MOST_GAIN_A still bounds the additional current. */
static inline @_sensed_output @_step_with_sensor(@_sensed_state *state, const @_input *measured, float reading_C) {
  @_sensed_output out;
  float last_C[@NODES@];
  float speed_rad_per_s;
  float sensed_A;
  float most_A;
  int node;
  bool is_over;
  const bool was_started = @_is_sensed_started(state);
  if (!was_started) {
    @_sensed_start(state, @CAP@_WINDING_LIMIT_C);
  }
  for (node = 0; node < @NODES@; ++node) {
    last_C[node] = state->model.state_C[node];
  }
  out.guard = @_step(&state->model, measured);
  out.model_only_A = out.guard.allowed_current_A;
  out.sensor = state->dropped;
  if (!was_started || state->dropped != @_sensor_used || out.guard.reason == @_input_unknown || out.guard.reason == @_not_started) {
    @_forget_sensor(state, out.guard.allowed_current_A);
    out.guard.reason = was_started ? out.guard.reason : @_not_started;
    return out;
  }
  is_over = @_is_over_allowed(state, measured->current_A);
  if (!is_over) {
    @_cap_model(state, last_C);
  }
  @_advance_sensed(state, measured, is_over);
  out.sensor = @_check_reading(state, reading_C, measured->ambient_C);
  if (out.sensor == @_sensor_used) {
    @_correct(state, reading_C);
    state->unread_s = 0.0f;
  } else {
    state->unread_s = state->unread_s < @CAP@_SENSOR_HOLD_S ? state->unread_s + @CAP@_PERIOD_S : @CAP@_SENSOR_HOLD_S;
@REJECTED@  }
  speed_rad_per_s = measured->speed_rad_per_s < 0.0f ? -measured->speed_rad_per_s : measured->speed_rad_per_s;
  state->capped_A = @_allowed_A(speed_rad_per_s, @_hottest_body_C(state->capped_C), state->capped_C[0]);
  sensed_A = @_current_with_sensor_A(state, speed_rad_per_s);
  most_A = state->capped_A + @CAP@_SENSOR_MOST_GAIN_A * (1.0f - state->cold_s / @CAP@_SENSOR_CONTRADICTION_S);
  sensed_A = sensed_A < most_A ? sensed_A : most_A;
  sensed_A = sensed_A < @CAP@_MOST_CURRENT_A ? sensed_A : @CAP@_MOST_CURRENT_A;
  out.model_only_A = state->capped_A;
  state->allowed_A = out.guard.allowed_current_A;
  if (state->dropped != @_sensor_used) {
    return out;
  }
  out.guard.allowed_current_A = sensed_A > 0.0f ? sensed_A : 0.0f;
  state->allowed_A = out.guard.allowed_current_A;
  out.guard.guarded_winding_C = state->state_C[0];
  out.guard.reason = @_reason_for(sensed_A, @_hottest_body_C(state->state_C), state->state_C[0]);
  if (out.guard.reason == @_full) {
    out.guard.reason = @_reason_for(sensed_A, @_hottest_body_C(state->capped_C), state->capped_C[0]);
  }
  return out;
}

)";

constexpr std::string_view kResistance = R"(/* The winding's temperature from its resistance, for @_step_with_sensor. */
typedef struct {
  float resistance_25C_ohm; /* mean of the calibration */
  int samples;              /* of the calibration */
  float rest_C;             /* temperature of the whole motor when the calibration began */
  float last_A;
} @_resistance;

/* Call after a rest at body_C. The first @CAP@_RESISTANCE_SAMPLES usable readings calibrate the sensor, if the winding warms by less than
   1 K meanwhile; else there are no readings until the next rest. Noise of the voltage counts with a quarter of its rms. */
static inline void @_resistance_start(@_resistance *sensor, float body_C) {
  sensor->resistance_25C_ohm = 0.0f;
  sensor->samples = 0;
  sensor->rest_C = body_C;
  sensor->last_A = 0.0f;
}

/* voltage_V: equivalent DC voltage at the terminals, mean over the period, > 0 when it drives a current > 0. Returns NAN if the current is
   too small, the motor too fast or the current changes too fast for the accuracy. */
static inline float @_resistance_reading_C(@_resistance *sensor, const @_sensed_state *state, const @_input *measured, float voltage_V) {
  const float nothing = @_number(0x7fc00000u); /* NaN */
  const float current_A = measured->current_A;
  const float speed_rad_per_s = measured->speed_rad_per_s;
  const float size_A = current_A < 0.0f ? -current_A : current_A;
  const float size_rad_per_s = speed_rad_per_s < 0.0f ? -speed_rad_per_s : speed_rad_per_s;
  const float nominal_C = state->model.nominal_C[0];
  const float change_A = current_A < sensor->last_A ? sensor->last_A - current_A : current_A - sensor->last_A;
  float resistance_ohm;
  sensor->last_A = current_A;
  if (!(size_A >= @CAP@_RESISTANCE_LEAST_CURRENT_A + @CAP@_RESISTANCE_CURRENT_PER_SPEED_A_S_PER_RAD * size_rad_per_s) ||
      !(change_A <= @CAP@_RESISTANCE_MOST_CURRENT_CHANGE_A)) {
    return nothing;
  }
  resistance_ohm = (voltage_V - @CAP@_TORQUE_CONSTANT_NM_PER_A * speed_rad_per_s) / current_A;
  if (!@_is_between(1e-6f, resistance_ohm, 1e6f)) {
    return nothing;
  }
  if (sensor->samples < @CAP@_RESISTANCE_SAMPLES && nominal_C - sensor->rest_C < 1.0f && sensor->rest_C - nominal_C < 1.0f) {
    const float at_25C_ohm = resistance_ohm / (1.0f + @CAP@_RESISTANCE_ALPHA_PER_K * (nominal_C - 25.0f));
    sensor->samples += 1;
    sensor->resistance_25C_ohm += (at_25C_ohm - sensor->resistance_25C_ohm) / (float)sensor->samples;
  }
  return sensor->samples >= @CAP@_RESISTANCE_SAMPLES && sensor->resistance_25C_ohm > 0.0f
             ? 25.0f + (resistance_ohm / sensor->resistance_25C_ohm - 1.0f) / @CAP@_RESISTANCE_ALPHA_PER_K
             : nothing;
}

)";

/// Readings that calibrate the resistance: their mean has a quarter of the noise of one.
constexpr int kResistanceSamples = 16;

/// A current up to this multiple of the allowed one counts as ripple of the current control.
constexpr double kRipple_ratio = 1.1;

std::string constants(const Source& source, const SensorPlan& plan) {
  const auto define = [&](std::string_view name, double value) {
    return fmt::format("#define {}_{} {}\n", source.capital, name, literal(value));
  };
  std::string text = define("SENSOR_ACCURACY_K", plan.options.accuracy_K) + define("SENSOR_MOST_GAIN_A", plan.most_gain_A) +
                     define("SENSOR_MOST_C", plan.check.most_C) + define("SENSOR_MOST_JUMP_K", plan.check.most_jump_K) +
                     define("SENSOR_MOST_RATE_K_PER_S", plan.check.most_rate_K_per_s) + define("SENSOR_COLD_RATIO", plan.check.cold_share) +
                     define("SENSOR_COLD_MARGIN_K", plan.check.cold_margin_K) + define("SENSOR_FROZEN_BAND_K", plan.check.frozen_band_K) +
                     define("SENSOR_FROZEN_K", plan.check.frozen_K) + define("SENSOR_CONTRADICTION_S", plan.check.contradiction_s) +
                     define("SENSOR_HOLD_S", plan.check.hold_s) + define("SENSOR_RIPPLE_RATIO", kRipple_ratio);
  if (plan.resistance) {
    text += define("RESISTANCE_ALPHA_PER_K", plan.resistance->temperature_coefficient_per_K) +
            define("RESISTANCE_LEAST_CURRENT_A", plan.resistance->least_current_A) +
            define("RESISTANCE_CURRENT_PER_SPEED_A_S_PER_RAD", plan.resistance->current_per_speed_A_s_per_rad) +
            define("RESISTANCE_MOST_CURRENT_CHANGE_A", std::min(plan.resistance->most_current_change_A, 1e9)) +
            fmt::format("#define {}_RESISTANCE_SAMPLES {}\n", source.capital, kResistanceSamples);
  }
  return text + "\n";
}

std::string comment(const SensorPlan& plan) {
  const Guarantee& checked = plan.guarantee;
  double most_drop_A = 0.0;
  for (const LastingCurrent& each : plan.lasting) {
    most_drop_A = std::max(most_drop_A, each.with_A - each.without_A);
  }
  return fmt::format(
      "\n"
      "/* With {} at the {} (largest error {:.3g} K{}): safety factor on heat {:.3g} instead of the above while the sensor is used.\n"
      " * The promise is that of the head comment, although each sensor reads too little by that error:\n"
      " * {}. The cross-check drops the correct sensor of {}.\n"
      " * A PLAUSIBLE BUT WRONG SENSOR allows at most SENSOR_MOST_GAIN_A more than model_only_A: the nominal motor then reaches {:.0f} "
      "degC\n"
      " * from a start at the hottest air, and {:.0f} degC from a warmer start, all nodes equally warm up to the winding limit; {} of {} "
      "drawn\n"
      " * motors exceed a limit. A dropped sensor lowers the current at once, under continuous load of the nominal motor by at most {} A.\n"
      " * Options of the sensor:\n"
      " * {}\n"
      " */\n",
      plan.resistance ? "the resistance from voltage and current" : "a thermistor",
      plan.observer.state_names()[static_cast<std::size_t>(plan.options.node)], plan.options.accuracy_K,
      plan.options.lag_s > 0.0 ? fmt::format(", lag {:.3g} s", plan.options.lag_s) : "", plan.observer.heat_safety_factor(),
      drawn_motors_text(checked), plan.dropped, plan.sensor_fault_nominal_C, plan.sensor_fault_warm_C, plan.sensor_fault_over,
      checked.samples, significant_above(most_drop_A, 2), sensor_flags(plan.options));
}

/// The table for the lower safety factor, computed with the same rules.
std::string sensed_table(const Source& source, const SensorPlan& plan) {
  const CurrentTable& table = plan.table;
  const std::string name = source.prefix + "_sensed";
  return "/* Table while the sensor is used. */\n" + table_comment(table) + array(name + "_speed_rad_per_s", table.speed_rad_per_s) +
         array(name + "_stator_C", table.stator_C) + array(name + "_winding_C", table.winding_C) +
         array(name + "_heat_per_ohm_A2", table.heat_per_ohm_A2) +
         fmt::format(
             "static const heatsoak_current_table {0}_table = {{\n    {{{0}_speed_rad_per_s, {1}}},\n    {{{0}_stator_C, {2}}},\n"
             "    {{{0}_winding_C, {3}}},\n    {0}_heat_per_ohm_A2,\n    {4},\n    {5},\n    {6},\n    {7},\n    {8},\n    {9},\n    "
             "{10}}};\n\n",
             name, table.speed_rad_per_s.size(), table.stator_C.size(), table.winding_C.size(), literal(table.resistance_at_0C_ratio),
             literal(table.resistance_ratio_per_K), literal(table.most_current_A), literal(table.straight_below_A),
             literal(table.most_speed_rad_per_s), literal(table.no_current_speed_rad_per_s), literal(table.winding_per_stator_K)) +
         fmt::format(
             "static inline float {0}_allowed_A(float speed_rad_per_s, float stator_C, float winding_C) {{\n"
             "  const heatsoak_row row = heatsoak_find_row(&{0}_table, speed_rad_per_s, stator_C);\n"
             "  return heatsoak_allowed_A(&{0}_table, &row, winding_C);\n}}\n\n",
             name);
}

std::string hottest_body(std::size_t nodes) {
  constexpr std::string_view kHead = "static inline float @_hottest_body_C(const float *state_C) {\n";
  if (nodes == 2) {
    return fmt::format("{}  return state_C[1];\n}}\n\n", kHead);
  }
  if (nodes == 3) {
    return fmt::format("{}  return state_C[2] > state_C[1] ? state_C[2] : state_C[1];\n}}\n\n", kHead);
  }
  return fmt::format(
      "{}  int node;\n  float hottest_C = state_C[1];\n  for (node = 2; node < {}; ++node) {{\n    hottest_C = state_C[node] > hottest_C ? "
      "state_C[node] : hottest_C;\n  }}\n  return hottest_C;\n}}\n\n",
      kHead, nodes);
}

}  // namespace

Rates sensor_functions(const Source& source) {
  if (!source.derating.sensor) {
    return {};
  }
  const SensorPlan& plan = *source.derating.sensor;
  const RateLines lines(plan.observer, plan.observer.rate_steps(), line_style());
  const bool lags = plan.options.lag_s > 0.0;
  const std::string node = fmt::format("state->state_C[{}]", plan.options.node);
  std::string gains;
  for (const double gain : plan.gain) {
    gains += (gains.empty() ? "" : ", ") + literal(gain);
  }
  const Words words{{"@PREDICTED@", lags ? "state->lag_C" : node},
                    {"@CORRECT_LAG@", lags ? fmt::format("  state->lag_C += {} * innovation_K;\n", literal(plan.lag_gain_ratio)) : ""},
                    {"@ADVANCE_LAG@", lags ? fmt::format("  state->lag_C += {} * ({} - state->lag_C);\n",
                                                         literal(source.derating.options.period_s / plan.options.lag_s), node)
                                           : ""},
                    // The resistance has no reading most of the time, so only readings that were rejected count.
                    {"@REJECTED@", plan.resistance ? "    if (out.sensor != @_sensor_silent) {\n      state->rejected += 1u;\n    }\n"
                                                   : "    state->rejected += 1u;\n"},
                    {"@GAINS@", gains},
                    {"@HOTTEST_BODY@", hottest_body(plan.observer.state_count())},
                    {"@RESERVE@", fmt::format("{:.3g}", plan.observer.heat_safety_factor())},
                    {"@SENSOR_NODE@", std::to_string(plan.options.node)},
                    {"@CAP@", source.capital},
                    {"@NODES@", std::to_string(plan.observer.state_count())},
                    {"@", source.prefix}};
  return {.text = comment(plan) + constants(source, plan) + replaced(kStructures, words) +
                  fmt::format("/* dT/dt of every node while the sensor is used */\nstatic inline void {0}_sensed_rates(const {0}_input "
                              "*input, const float *state_C, float *rate_K_per_s) {{\n{1}}}\n\n",
                              source.prefix, lines.text()) +
                  sensed_table(source, plan) + replaced(kCheck, words) + replaced(kSensedStep, words) +
                  (plan.resistance ? replaced(kResistance, words) : ""),
          .calls_thermal_math = lines.calls_thermal_math()};
}

}  // namespace heatsoak::derate::c_header
