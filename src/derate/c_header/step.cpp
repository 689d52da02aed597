#include <fmt/format.h>

#include <algorithm>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/plausible_range.h"

namespace heatsoak::derate::c_header {
namespace {

constexpr std::string_view kStart = R"(/* Both return false for NaN; the second also for a temperature that no motor can have. */
static inline bool @_is_between(float low, float x, float high) { return x >= low && x <= high; }
static inline bool @_is_temperature(float x) {
  return @_is_between(@CAP@_COLDEST_AMBIENT_C - 1.0f, x, @CAP@_MOST_STATE_C);
}

/* Keeps a node between the coldest air and @CAP@_MOST_STATE_C: a hotter one counts as that hot. */
static inline float @_bounded_C(float x) {
  const float above_C = x > @CAP@_COLDEST_AMBIENT_C ? x : @CAP@_COLDEST_AMBIENT_C;
  return above_C < @CAP@_MOST_STATE_C ? above_C : @CAP@_MOST_STATE_C;
}

/* body_C: temperature of the whole motor after a rest; an implausible value counts as the limit. */
static inline void @_start(@_state *state, float body_C) {
  int node;
  const float start_C = @_is_temperature(body_C) ? body_C : @CAP@_WINDING_LIMIT_C;
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = start_C;
    state->nominal_C[node] = start_C;
    state->carry_K[node] = 0.0f;
    state->nominal_carry_K[node] = 0.0f;
  }
  state->started = @CAP@_STARTED;
}

)";

constexpr std::string_view kSweep =
    R"(/* Each node takes its largest heating rate over the possible values; the input takes the value that heats the winding most. */
static inline void @_sweep(const @_input *in, float *input, const float *possible, int count, const float *state_C, float *most_K_per_s) {
  float rate_K_per_s[@NODES@];
  float hottest = possible[0];
  float hottest_K_per_s = -1e30f;
  int i;
  int node;
  for (i = 0; i < count; ++i) {
    *input = possible[i];
    @_rates(in, state_C, rate_K_per_s);
    for (node = 0; node < @NODES@; ++node) {
      most_K_per_s[node] = rate_K_per_s[node] > most_K_per_s[node] ? rate_K_per_s[node] : most_K_per_s[node];
    }
    if (rate_K_per_s[0] > hottest_K_per_s) {
      hottest_K_per_s = rate_K_per_s[0];
      hottest = possible[i];
    }
  }
  *input = hottest;
}

)";

constexpr std::string_view kStep = R"(/* One period; the rounding error of each step is carried to the next (Kahan 1965). */
static inline void @_advance(float *state_C, float *carry_K, const float *rate_K_per_s) {
  int node;
  for (node = 0; node < @NODES@; ++node) {
    const float change_K = @CAP@_PERIOD_S * rate_K_per_s[node] - carry_K[node];
    const float next_C = state_C[node] + change_K;
    carry_K[node] = (next_C - state_C[node]) - change_K;
    state_C[node] = @_bounded_C(next_C);
  }
}

/* stator_C: the hottest node other than the winding. Below the first points of their axes, temperatures do not reduce the current. */
static inline @_reason @_reason_for(float allowed_A, float stator_C, float winding_C) {
  const bool is_cool = stator_C <= @_stator_C[0] && winding_C <= @_winding_C[0];
  if (!(allowed_A > 0.0f)) {
    return @_no_current;
  }
  return allowed_A >= @CAP@_MOST_CURRENT_A || is_cool ? @_full : @_derated;
}

static inline @_output @_step(@_state *state, const @_input *measured) {
  @_output out;
  @_input in = *measured;
  float rate_K_per_s[@NODES@];
  float nominal_K_per_s[@NODES@];
  float hottest_body_C;
  float speed_rad_per_s;
  int node;
@PASS@  bool is_started = state->started == @CAP@_STARTED;
  uint32_t unknown = 0u;
  for (node = 0; node < @NODES@; ++node) {
    is_started = is_started && @_is_temperature(state->state_C[node]) && @_is_temperature(state->nominal_C[node]);
    is_started = is_started && @_is_between(-1.0f, state->carry_K[node], 1.0f);
    is_started = is_started && @_is_between(-1.0f, state->nominal_carry_K[node], 1.0f);
  }
  if (!is_started) {
    @_start(state, @CAP@_WINDING_LIMIT_C);
  }
@UNKNOWN@  @_rates(&in, state->state_C, rate_K_per_s);
@SWEEPS@  @_nominal_rates(&in, state->nominal_C, nominal_K_per_s);
  @_advance(state->state_C, state->carry_K, rate_K_per_s);
  @_advance(state->nominal_C, state->nominal_carry_K, nominal_K_per_s);
  hottest_body_C = state->state_C[1];
@BODIES@  speed_rad_per_s = in.speed_rad_per_s < 0.0f ? -in.speed_rad_per_s : in.speed_rad_per_s;
  out.guarded_winding_C = state->state_C[0];
  out.nominal_winding_C = state->nominal_C[0];
  out.allowed_current_A = (unknown & @SPEED_BIT@u) != 0u ? 0.0f : @_allowed_A(speed_rad_per_s, hottest_body_C, out.guarded_winding_C);
  if (!is_started) {
    out.reason = @_not_started;
  } else if (unknown != 0u) {
    out.reason = @_input_unknown;
  } else {
    out.reason = @_reason_for(out.allowed_current_A, hottest_body_C, out.guarded_winding_C);
  }
  return out;
}
)";

constexpr std::string_view kBodies = R"(  for (node = 2; node < @NODES@; ++node) {
    hottest_body_C = state->state_C[node] > hottest_body_C ? state->state_C[node] : hottest_body_C;
  }
)";

/// The same for the only node beyond winding and stator.
constexpr std::string_view kThirdBody = "  hottest_body_C = state->state_C[2] > hottest_body_C ? state->state_C[2] : hottest_body_C;\n";

/// Returns the signals with several candidate values; a signal with a single one needs no sweep.
std::vector<observed::Signal> swept_signals(const Source& source) {
  std::vector<observed::Signal> swept = source.signals;
  std::erase_if(swept, [&](observed::Signal signal) { return plausible_range(source.derating, signal).values.size() < 2; });
  return swept;
}

unsigned bit(observed::Signal signal) { return 1U << static_cast<unsigned>(signal); }

/// Name of the constant of an input: PREFIX_LEAST_PLAUSIBLE_CURRENT_A.
std::string constant_of(const Source& source, std::string_view what, observed::Signal signal) {
  return fmt::format("{}_{}_{}", source.capital, what, in_capitals(std::string(name_of(signal))));
}

/// Lower end of the plausible range as an expression. That of the neighbour follows the air.
std::string least_of(const Source& source, observed::Signal signal) {
  const PlausibleRange validated = plausible_range(source.derating, signal);
  if (signal == observed::neighbour) {
    return fmt::format("in.ambient_C - {}", literal(kNeighbourBelowAir_K));
  }
  return validated.low == -validated.high ? fmt::format("-{}", constant_of(source, "MOST_PLAUSIBLE", signal))
                                          : constant_of(source, "LEAST_PLAUSIBLE", signal);
}

/// Generates the checks that replace implausible readings. Each gets a value before the sweeps, because a NaN would spoil every rate.
std::string plausible_ranges(const Source& source) {
  std::string text;
  for (const observed::Signal signal : source.signals) {
    text += fmt::format("  if (!{0}_is_between({1}, in.{2}, {3})) {{\n    in.{2} = {4};\n    unknown |= {5}u;\n  }}\n", source.prefix,
                        least_of(source, signal), name_of(signal), constant_of(source, "MOST_PLAUSIBLE", signal),
                        constant_of(source, "UNKNOWN", signal), bit(signal));
  }
  return text;
}

/// Generates the sweeps over candidate values. Several signals need two passes, because the hottest value of one may depend on another.
std::string sweeps(const Source& source, const std::vector<observed::Signal>& swept) {
  const std::string indent = swept.size() > 1 ? "    " : "  ";
  std::string text = swept.size() > 1 ? "  for (pass = 0; pass < 2; ++pass) {\n" : "";
  for (const observed::Signal signal : swept) {
    text += fmt::format(
        "{4}if ((unknown & {0}u) != 0u) {{\n{4}  {1}_sweep(&in, &in.{2}, {1}_possible_{2}, {3}, state->state_C, rate_K_per_s);\n{4}}}\n",
        bit(signal), source.prefix, name_of(signal), plausible_range(source.derating, signal).values.size(), indent);
  }
  return text + (swept.size() > 1 ? "  }\n" : "");
}

}  // namespace

std::string plausible_constants(const Source& source) {
  std::string text =
      "/* A reading outside of its plausible range is replaced by the UNKNOWN value: the hottest that motor, driver and battery permit. "
      "*/\n";
  for (const observed::Signal signal : source.signals) {
    const PlausibleRange range = plausible_range(source.derating, signal);
    if (least_of(source, signal) == constant_of(source, "LEAST_PLAUSIBLE", signal)) {
      text += fmt::format("#define {} {}\n", constant_of(source, "LEAST_PLAUSIBLE", signal), literal(range.low));
    }
    text += fmt::format("#define {} {}\n#define {} {}\n", constant_of(source, "MOST_PLAUSIBLE", signal), literal(range.high),
                        constant_of(source, "UNKNOWN", signal), literal(range.values.front()));
  }
  return text + "\n";
}

std::string candidates(const Source& source) {
  std::string text;
  for (const observed::Signal signal : swept_signals(source)) {
    const std::vector<float> values = plausible_range(source.derating, signal).values;
    text += array(fmt::format("{}_possible_{}", source.prefix, name_of(signal)), {values.begin(), values.end()});
  }
  return text.empty() ? text : "/* possible values of an unknown input */\n" + text + "\n";
}

std::string step_functions(const Source& source) {
  const std::vector<observed::Signal> swept = swept_signals(source);
  const std::size_t nodes = source.derating.observer.state_count();
  const Words words{{"@UNKNOWN@", plausible_ranges(source)},
                    {"@SWEEPS@", sweeps(source, swept)},
                    {"@BODIES@", std::string(nodes == 3  ? kThirdBody
                                             : nodes > 3 ? kBodies
                                                         : "")},
                    {"@PASS@", swept.size() > 1 ? "  int pass;\n" : ""},
                    {"@SPEED_BIT@", std::to_string(bit(observed::speed))},
                    {"@CAP@", source.capital},
                    {"@NODES@", std::to_string(nodes)},
                    {"@", source.prefix}};
  return replaced(kStart, words) + (swept.empty() ? "" : replaced(kSweep, words)) + replaced(kStep, words);
}

}  // namespace heatsoak::derate::c_header
