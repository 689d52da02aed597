#include <fmt/format.h>

#include <algorithm>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/plausible_range.h"

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

/* Longest Euler step at these temperatures: 1/20 of a lower bound of the shortest time constant. Its rate is at most the largest row sum
   of the absolute derivatives (Gershgorin). */
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
  return fastest_per_s > 0.0f ? 0.05f / fastest_per_s : @CAP@_PERIOD_S;
}

/* Cool-down without current in the hottest air, in at most @CAP@_MOST_COOLING_STEPS steps.
   Time beyond them cools no node, and warms each one to the hottest surroundings. peak_C: highest temperature of each node during this time. */
static inline void @_cool(@_law law, float elapsed_s, float *state_C, float *peak_C) {
  @_input off;
  float rate_K_per_s[@NODES@];
  float carry_K[@NODES@];
  float step_s;
  float left_s = elapsed_s;
  int node;
  int step;
  @_clear((unsigned char *)&off, (int)sizeof off);
  off.ambient_C = @CAP@_HOTTEST_AMBIENT_C;
@OFF@  step_s = @_cooling_step_s(law, &off, state_C);
  for (node = 0; node < @NODES@; ++node) {
    peak_C[node] = state_C[node];
    carry_K[node] = 0.0f;
  }
  for (step = 0; step < @CAP@_MOST_COOLING_STEPS && left_s > 0.0f; ++step) {
    const float this_s = left_s < step_s ? left_s : step_s;
    law(&off, state_C, rate_K_per_s);
    for (node = 0; node < @NODES@; ++node) {
      const float change_K = this_s * rate_K_per_s[node] - carry_K[node];
      const float next_C = state_C[node] + change_K;
      carry_K[node] = (next_C - state_C[node]) - change_K;
      state_C[node] = next_C;
      peak_C[node] = next_C > peak_C[node] ? next_C : peak_C[node];
    }
    left_s -= this_s;
  }
  for (node = 0; node < @NODES@ && left_s > 0.0f; ++node) {
    state_C[node] = state_C[node] > @WARMEST@ ? state_C[node] : @WARMEST@;
    peak_C[node] = state_C[node] > peak_C[node] ? state_C[node] : peak_C[node];
  }
}

/* Highest temperature that each node can have after elapsed_s; negative or NaN: unknown, so at any time since the save. An Euler step of
   1/20 of a time constant cools as 1/20 + 1/800 of one would. A node that cools therefore takes its temperature after 97 % of the time,
   and one that warms its highest since then. */
static inline void @_rest(@_law law, float elapsed_s, float *state_C) {
  float peak_C[@NODES@];
  const bool is_known = elapsed_s >= 0.0f;
  int node;
  if (is_known) {
    @_cool(law, 0.97f * elapsed_s, state_C, peak_C);
  }
  @_cool(law, is_known ? 0.03f * elapsed_s : 1e9f, state_C, peak_C);
  for (node = 0; node < @NODES@; ++node) {
    state_C[node] = peak_C[node];
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
  on.ambient_C = @CAP@_HOTTEST_AMBIENT_C;
@ON@  for (step = 0; step < @CAP@_MOST_COOLING_STEPS && left_s > 0.0f; ++step) {
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
    R"(/* elapsed_s: time without power, from a clock that kept running; negative or NaN: unknown. After an unknown time each node takes the
   highest temperature that it can have had since the save, heat from the other nodes included, because power may have returned at once.
   unsaved_s: longest time from the last save to the loss of power; 0 if the falling supply triggers the save; NaN counts as very long.
   board_C: lower bound of every node, because the motor was in the same surroundings; an implausible value counts as the hottest air. */
static inline @_restored_from @_restore(@_state *state, const uint8_t *buffer, float elapsed_s, float unsaved_s, float board_C) {
  const float least_C = @_is_temperature(board_C) ? board_C : @CAP@_HOTTEST_AMBIENT_C;
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
    @_heat(@_rates, unsaved_s < 1e9f ? unsaved_s : 1e9f, state->state_C);
    @_heat(@_nominal_rates, unsaved_s < 1e9f ? unsaved_s : 1e9f, state->nominal_C);
  }
  @_rest(@_rates, elapsed_s, state->state_C);
  @_rest(@_nominal_rates, elapsed_s, state->nominal_C);
  for (node = 0; node < @NODES@; ++node) {
    state->state_C[node] = state->state_C[node] > least_C ? state->state_C[node] : least_C;
    state->nominal_C[node] = state->nominal_C[node] > least_C ? state->nominal_C[node] : least_C;
    state->carry_K[node] = 0.0f;
    state->nominal_carry_K[node] = 0.0f;
  }
  state->started = @CAP@_STARTED;
  return elapsed_s >= 0.0f ? @_restored : @_time_unknown;
}

)";

/// Assigns worst-case values to signals that are unknown without power: a neighbour at its limit, and the largest age.
std::string unwatched_signals(const Source& source, std::string_view input) {
  std::string text;
  for (const observed::Signal signal : source.signals) {
    if (signal == observed::neighbour) {
      text += fmt::format("  {}.{} = {}_WINDING_LIMIT_C;\n", input, name_of(signal), source.capital);
    } else if (signal == observed::age) {
      text += fmt::format("  {}.{} = {};\n", input, name_of(signal),
                          literal(std::ranges::max(plausible_range(source.derating, signal).values)));
    }
  }
  return text;
}

}  // namespace

std::string memory_functions(const Source& source, unsigned signature) {
  const std::size_t nodes = source.derating.observer.state_count();
  constexpr int kMostCoolingSteps = 4096;
  const std::vector<float> speeds = plausible_range(source.derating, observed::speed).values;
  const bool has_one_speed = speeds.size() == 1;
  std::string speed_list;
  for (const float speed_rad_per_s : speeds) {
    speed_list += (speed_list.empty() ? "" : ", ") + literal(speed_rad_per_s);
  }
  const Words words{
      {"@OFF@", unwatched_signals(source, "off")},
      {"@WARMEST@", plausible_range(source.derating, observed::neighbour).is_used ? "@CAP@_WINDING_LIMIT_C" : "@CAP@_HOTTEST_AMBIENT_C"},
      {"@ON@", unwatched_signals(source, "on") + (has_one_speed ? "  on.speed_rad_per_s = @CAP@_UNKNOWN_SPEED_RAD_PER_S;\n" : "")},
      {"@SPEED_LIST@", has_one_speed ? "" : fmt::format("  const float possible_rad_per_s[@SPEEDS@] = {{{}}};\n", speed_list)},
      {"@SPEED_INDEX@", has_one_speed ? "" : "  int speed;\n"},
      {"@LOADS@", std::string(has_one_speed ? kLoadsOfOneSpeed : kLoadsOfSpeeds)},
      {"@SPEEDS@", std::to_string(speeds.size())},
      {"@SIZE@", std::to_string(4 * (2 + 2 * nodes))},
      {"@CAP@", source.capital},
      {"@NODES@", std::to_string(nodes)},
      {"@", source.prefix}};
  return fmt::format("\n#define {0}_SIGNATURE 0x{1:08x}u\n#define {0}_MOST_COOLING_STEPS {2}\n", source.capital, signature,
                     kMostCoolingSteps) +
         replaced(kPacked, words) + replaced(kCool, words) + replaced(kUnsaved, words) + replaced(kRestore, words);
}

}  // namespace heatsoak::derate::c_header
