#include <fmt/format.h>

#include <algorithm>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/plausible_range.h"
#include "derate/power_off.h"

namespace heatsoak::derate::c_header {
namespace {

constexpr std::string_view kPacked =
    R"(/* Data saved over power-off: signature of motor and guard (@CAP@_SIGNATURE), temperatures and
   CRC-32 (IEEE 802.3); little-endian. */
#define @CAP@_SAVED_SIZE @SIZE@
typedef enum {
  @_restored,        /* cooled for the elapsed time */
  @_time_unknown,    /* time without power unknown: each node takes its highest safe temperature */
  @_nothing_restored /* not saved, damaged or of another guard: starts as hot as the limit */
} @_restored_from;

static inline void @_pack(uint8_t *to, uint32_t word) {
  to[0] = (uint8_t)(word & 0xffu);
  to[1] = (uint8_t)((word >> 8) & 0xffu);
  to[2] = (uint8_t)((word >> 16) & 0xffu);
  to[3] = (uint8_t)((word >> 24) & 0xffu);
}

static inline uint32_t @_unpack(const uint8_t *from) {
  return (uint32_t)from[0] | ((uint32_t)from[1] << 8) | ((uint32_t)from[2] << 16) | ((uint32_t)from[3] << 24);
}

static inline void @_clear(unsigned char *to, int size) {
  int i;
  for (i = 0; i < size; ++i) {
    to[i] = 0u;
  }
}

static inline void @_copy_4(unsigned char *to, const unsigned char *from) {
  to[0] = from[0];
  to[1] = from[1];
  to[2] = from[2];
  to[3] = from[3];
}

static inline uint32_t @_bits(float x) {
  uint32_t word = 0u;
  @_copy_4((unsigned char *)&word, (const unsigned char *)&x);
  return word;
}

static inline float @_number(uint32_t word) {
  float x = 0.0f;
  @_copy_4((unsigned char *)&x, (const unsigned char *)&word);
  return x;
}

/* buffer: @CAP@_SAVED_SIZE bytes. Call it at regular intervals and when the supply voltage falls. */
static inline void @_save(const @_state *state, uint8_t *buffer) {
  int node;
  @_pack(buffer, state->started == @CAP@_STARTED ? @CAP@_SIGNATURE : 0u);
  for (node = 0; node < @NODES@; ++node) {
    @_pack(&buffer[4 + 4 * node], @_bits(state->state_C[node]));
    @_pack(&buffer[4 + 4 * (@NODES@ + node)], @_bits(state->nominal_C[node]));
  }
  @_pack(&buffer[@CAP@_SAVED_SIZE - 4], heatsoak_crc_32(buffer, @CAP@_SAVED_SIZE - 4));
}

)";

constexpr std::string_view kCool = R"(typedef void (*@_law)(const @_input *, const float *, float *);

/* Length of a cooling step at these temperatures: 1/5 of a lower bound of the shortest time constant. Its rate is at most the largest row
   sum of the absolute derivatives (Gershgorin). */
static inline float @_cooling_step_s(@_law law, const @_input *off, const float *state_C) {
  float moved_C[@NODES@];
  float rate_K_per_s[@NODES@];
  float moved_K_per_s[@NODES@];
  float sum_per_s[@NODES@];
  float fastest_per_s = 0.0f;
  int from;
  int node;
  law(off, state_C, rate_K_per_s);
  for (node = 0; node < @NODES@; ++node) {
    moved_C[node] = state_C[node];
    sum_per_s[node] = 0.0f;
  }
  for (from = 0; from < @NODES@; ++from) {
    moved_C[from] += 1.0f;
    law(off, moved_C, moved_K_per_s);
    moved_C[from] -= 1.0f;
    for (node = 0; node < @NODES@; ++node) {
      const float change_per_s = moved_K_per_s[node] - rate_K_per_s[node];
      sum_per_s[node] += change_per_s < 0.0f ? -change_per_s : change_per_s;
    }
  }
  for (node = 0; node < @NODES@; ++node) {
    fastest_per_s = sum_per_s[node] > fastest_per_s ? sum_per_s[node] : fastest_per_s;
  }
  return fastest_per_s > 0.0f ? 0.2f / fastest_per_s : @CAP@_PERIOD_S;
}

/* One step of the classical method of Runge and Kutta. peak_C: raised to the highest temperature of each node during the step; between its
   ends a node that first warms and then cools follows a parabola. */
static inline void @_cool_for(@_law law, const @_input *off, float step_s, float *state_C, float *carry_K, float *peak_C) {
  float rate_K_per_s[4][@NODES@];
  float ahead_C[@NODES@];
  int node;
  int stage;
  law(off, state_C, rate_K_per_s[0]);
  for (stage = 1; stage < 4; ++stage) {
    const float ahead_s = stage == 3 ? step_s : 0.5f * step_s;
    for (node = 0; node < @NODES@; ++node) {
      ahead_C[node] = state_C[node] + ahead_s * rate_K_per_s[stage - 1][node];
    }
    law(off, ahead_C, rate_K_per_s[stage]);
  }
  for (node = 0; node < @NODES@; ++node) {
    const float first = rate_K_per_s[0][node];
    const float last = rate_K_per_s[3][node];
    const float mean = (first + 2.0f * (rate_K_per_s[1][node] + rate_K_per_s[2][node]) + last) / 6.0f;
    const float change_K = step_s * mean - carry_K[node];
    const float next_C = state_C[node] + change_K;
    const float top_C = first > 0.0f && last < 0.0f ? next_C + 0.5f * step_s * last * last / (first - last) : next_C;
    carry_K[node] = (next_C - state_C[node]) - change_K;
    state_C[node] = next_C;
    peak_C[node] = top_C > peak_C[node] ? top_C : peak_C[node];
  }
}

/* Cools without current in the hottest air; elapsed_s negative: for an unknown time, so that each node takes the highest temperature
   that it can have had. In the time beyond the largest number of steps, each node is at most as far above its resting temperature as the
   node that is farthest above. */
static inline void @_cool(@_law law, const float *resting_C, float elapsed_s, float *state_C) {
  const bool is_known = elapsed_s >= 0.0f;
  @_input off;
  float carry_K[@NODES@];
  float peak_C[@NODES@];
  float left_s = is_known ? elapsed_s : 1e9f;
  float above_K = 0.0f;
  float longest_s = 0.0f;
  int node;
  int step;
  @_clear((unsigned char *)&off, (int)sizeof off);
@OFF@  for (node = 0; node < @NODES@; ++node) {
    peak_C[node] = state_C[node];
    carry_K[node] = 0.0f;
  }
  for (step = 0; step < @CAP@_MOST_COOLING_STEPS && left_s > 0.0f; ++step) {
    float step_s;
    /* The time constants may change while the motor cools. */
    if ((step % 4) == 0) {
      longest_s = @_cooling_step_s(law, &off, state_C);
    }
    step_s = left_s < longest_s ? left_s : longest_s;
    @_cool_for(law, &off, step_s, state_C, carry_K, peak_C);
    left_s -= step_s;
  }
  for (node = 0; node < @NODES@; ++node) {
    above_K = state_C[node] - resting_C[node] > above_K ? state_C[node] - resting_C[node] : above_K;
  }
  for (node = 0; node < @NODES@; ++node) {
    const float later_C = left_s > 0.0f ? resting_C[node] + above_K : state_C[node];
    state_C[node] = is_known || later_C > peak_C[node] ? later_C : peak_C[node];
  }
}

)";

/// With saves at regular intervals the motor may have run since the last one. Assumes the highest load that the guard can have allowed.
constexpr std::string_view kUnsaved =
    R"(/* Worst-case heating: the driver's largest current at the accepted speed that heats most, up to the limit that the guard has
   kept, or up to the hottest node if that is hotter. No node cools. */
static inline void @_heat(@_law law, float unsaved_s, float *state_C) {
  const float possible_A[2] = {@CAP@_MOST_CURRENT_A, -@CAP@_MOST_CURRENT_A};
@SPEED_LIST@  @_input on;
  float rate_K_per_s[@NODES@];
  float most_K_per_s[@NODES@];
  float most_C = @CAP@_WINDING_LIMIT_C;
  float left_s = unsaved_s;
  int node;
  int direction;
@SPEED_INDEX@  int step;
  for (node = 0; node < @NODES@; ++node) {
    most_C = state_C[node] > most_C ? state_C[node] : most_C;
  }
  @_clear((unsigned char *)&on, (int)sizeof on);
@ON@  for (step = 0; step < @CAP@_MOST_HEATING_STEPS && left_s > 0.0f; ++step) {
    @_clear((unsigned char *)most_K_per_s, (int)sizeof most_K_per_s);
@LOADS@    for (node = 0; node < @NODES@; ++node) {
      const float next_C = state_C[node] + @CAP@_PERIOD_S * most_K_per_s[node];
      state_C[node] = next_C < most_C ? next_C : most_C;
    }
    left_s -= @CAP@_PERIOD_S;
  }
  for (node = 0; node < @NODES@ && left_s > 0.0f; ++node) {
    state_C[node] = most_C;
  }
}

)";

constexpr std::string_view kLoadsOfOneSpeed = R"(    for (direction = 0; direction < 2; ++direction) {
      on.current_A = possible_A[direction];
      law(&on, state_C, rate_K_per_s);
      for (node = 0; node < @NODES@; ++node) {
        most_K_per_s[node] = rate_K_per_s[node] > most_K_per_s[node] ? rate_K_per_s[node] : most_K_per_s[node];
      }
    }
)";
constexpr std::string_view kLoadsOfSpeeds = R"(    for (speed = 0; speed < @SPEEDS@; ++speed) {
      on.speed_rad_per_s = possible_rad_per_s[speed];
      for (direction = 0; direction < 2; ++direction) {
        on.current_A = possible_A[direction];
        law(&on, state_C, rate_K_per_s);
        for (node = 0; node < @NODES@; ++node) {
          most_K_per_s[node] = rate_K_per_s[node] > most_K_per_s[node] ? rate_K_per_s[node] : most_K_per_s[node];
        }
      }
    }
)";

constexpr std::string_view kRestore =
    R"(/* elapsed_s: time without power, from a clock that kept running; negative, not finite or 1e9 s or more: unknown. After an unknown time each
   node takes the highest temperature that it can have had since the save, heat from the other nodes included, because power may have
   returned at once.
   unsaved_s: longest time from the last save to the loss of power; 0 if the falling supply triggers the save; NaN counts as very long.
   board_C: lower bound of every node, because the motor was in the same surroundings; an implausible value counts as the hottest air. */
static inline @_restored_from @_restore(@_state *state, const uint8_t *buffer, float elapsed_s, float unsaved_s, float board_C) {
  const float least_C = @_is_temperature(board_C) ? board_C : @CAP@_HOTTEST_AMBIENT_C;
  const float known_s = elapsed_s < 1e9f ? elapsed_s : -1.0f;
  int node;
  bool is_whole = @_unpack(buffer) == @CAP@_SIGNATURE &&
                  @_unpack(&buffer[@CAP@_SAVED_SIZE - 4]) == heatsoak_crc_32(buffer, @CAP@_SAVED_SIZE - 4);
  for (node = 0; node < @NODES@; ++node) {
    const float saved_C = @_number(@_unpack(&buffer[4 + 4 * node]));
    const float saved_nominal_C = @_number(@_unpack(&buffer[4 + 4 * (@NODES@ + node)]));
    state->state_C[node] = saved_C > @CAP@_MOST_STATE_C ? @CAP@_MOST_STATE_C : saved_C;
    state->nominal_C[node] = saved_nominal_C > @CAP@_MOST_STATE_C ? @CAP@_MOST_STATE_C : saved_nominal_C;
    is_whole = is_whole && @_is_temperature(state->state_C[node]) && @_is_temperature(state->nominal_C[node]);
  }
  if (!is_whole) {
    @_start(state, @CAP@_WINDING_LIMIT_C);
    return @_nothing_restored;
  }
  if (!(unsaved_s <= 0.0f)) {
    @_heat(@GUARD_LAW@, unsaved_s < 1e9f ? unsaved_s : 1e9f, state->state_C);
    @_heat(@NOMINAL_LAW@, unsaved_s < 1e9f ? unsaved_s : 1e9f, state->nominal_C);
  }
  @_cool(@GUARD_LAW@, @_resting_C, known_s, state->state_C);
  @_cool(@NOMINAL_LAW@, @NOMINAL_RESTING@, known_s, state->nominal_C);
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = state->state_C[node] > least_C ? state->state_C[node] : least_C;
    state->nominal_C[node] = state->nominal_C[node] > least_C ? state->nominal_C[node] : least_C;
    state->carry_K[node] = 0.0f;
    state->nominal_carry_K[node] = 0.0f;
  }
  state->started = @CAP@_STARTED;
  return known_s >= 0.0f ? @_restored : @_time_unknown;
}

)";

/// Assigns the values without power that are not 0.
std::string unwatched_signals(const Source& source, std::string_view input) {
  std::string text;
  for (const observed::Signal signal : source.signals) {
    switch (observed::signals()[static_cast<std::size_t>(signal)].without_power) {
      case thermal::WithoutPower::unstated:
      case thermal::WithoutPower::zero:
      case thermal::WithoutPower::any:
        break;
      case thermal::WithoutPower::hottest_air:
        text += fmt::format("  {}.{} = {}_HOTTEST_AMBIENT_C;\n", input, name_of(signal), source.capital);
        break;
      case thermal::WithoutPower::winding_limit:
        text += fmt::format("  {}.{} = {}_WINDING_LIMIT_C;\n", input, name_of(signal), source.capital);
        break;
    }
  }
  return text;
}

constexpr std::string_view kAnyAge = R"(/* Largest rate of each node over the possible ages: without power the age is not known. */
static inline void @FUNCTION@(const @_input *input, const float *state_C, float *rate_K_per_s) {
  @_input each = *input;
  float of_age_K_per_s[@NODES@];
  int i;
  int node;
  for (i = 0; i < @AGES@; ++i) {
    each.age_h = @_any_age_h[i];
    @LAW@(&each, state_C, of_age_K_per_s);
    for (node = 0; node < @NODES@; ++node) {
      rate_K_per_s[node] = i == 0 || of_age_K_per_s[node] > rate_K_per_s[node] ? of_age_K_per_s[node] : rate_K_per_s[node];
    }
  }
}

)";

/// Functions of the laws at an unknown age; empty if no law depends on it.
std::string laws_of_any_age(const Source& source, const Words& words) {
  const std::vector<float> ages_h = ages_without_power_h(source.derating);
  if (ages_h.empty()) {
    return {};
  }
  std::string text = array(source.prefix + "_any_age_h", {ages_h.begin(), ages_h.end()}) + "\n";
  for (const std::string_view law : {"rates", "nominal_rates"}) {
    Words own{{"@FUNCTION@", fmt::format("{}_{}_of_any_age", source.prefix, law)},
              {"@LAW@", fmt::format("{}_{}", source.prefix, law)},
              {"@AGES@", std::to_string(ages_h.size())}};
    own.insert(own.end(), words.begin(), words.end());
    text += replaced(kAnyAge, own);
  }
  return text;
}

/// Constants with the temperatures to which the nodes cool.
std::string resting_temperatures(const Source& source, const std::vector<double>& guard_C, const std::vector<double>& nominal_C) {
  std::string text = "\n/* Resting temperatures: steady state of the nodes without current in the hottest air, rounded up. */\n" +
                     array(source.prefix + "_resting_C", guard_C);
  return nominal_C == guard_C ? text : text + array(source.prefix + "_nominal_resting_C", nominal_C);
}

}  // namespace

std::string memory_functions(const Source& source, unsigned signature) {
  const std::size_t nodes = source.derating.observer.state_count();
  const std::vector<float> speeds = plausible_range(source.derating, observed::speed).values;
  const bool has_one_speed = speeds.size() == 1;
  std::string speed_list;
  for (const float speed_rad_per_s : speeds) {
    speed_list += (speed_list.empty() ? "" : ", ") + literal(speed_rad_per_s);
  }
  const std::vector<double> guard_C = resting_C(source.derating, source.derating.observer.rate_steps());
  const std::vector<double> nominal_C = resting_C(source.derating, source.derating.observer.nominal_rate_steps());
  const bool has_age = !ages_without_power_h(source.derating).empty();
  const Words words{
      {"@OFF@", unwatched_signals(source, "off")},
      {"@GUARD_LAW@", has_age ? "@_rates_of_any_age" : "@_rates"},
      {"@NOMINAL_LAW@", has_age ? "@_nominal_rates_of_any_age" : "@_nominal_rates"},
      {"@NOMINAL_RESTING@", nominal_C == guard_C ? "@_resting_C" : "@_nominal_resting_C"},
      {"@ON@", unwatched_signals(source, "on") + (has_one_speed ? "  on.speed_rad_per_s = @CAP@_UNKNOWN_SPEED_RAD_PER_S;\n" : "")},
      {"@SPEED_LIST@", has_one_speed ? "" : fmt::format("  const float possible_rad_per_s[@SPEEDS@] = {{{}}};\n", speed_list)},
      {"@SPEED_INDEX@", has_one_speed ? "" : "  int speed;\n"},
      {"@LOADS@", std::string(has_one_speed ? kLoadsOfOneSpeed : kLoadsOfSpeeds)},
      {"@SPEEDS@", std::to_string(speeds.size())},
      {"@SIZE@", std::to_string(4 * (2 + 2 * nodes))},
      {"@CAP@", source.capital},
      {"@NODES@", std::to_string(nodes)},
      {"@", source.prefix}};
  return fmt::format("\n#define {0}_SIGNATURE 0x{1:08x}u\n#define {0}_MOST_COOLING_STEPS {2}\n#define {0}_MOST_HEATING_STEPS {3}\n",
                     source.capital, signature, kMostCoolingSteps, kMostHeatingSteps) +
         resting_temperatures(source, guard_C, nominal_C) + "\n" + replaced(kPacked, words) + laws_of_any_age(source, words) +
         replaced(kCool, words) + replaced(kUnsaved, words) + replaced(kRestore, words);
}

}  // namespace heatsoak::derate::c_header
