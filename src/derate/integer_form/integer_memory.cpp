#include "derate/integer_form/integer_memory.h"

#include <fmt/format.h>

#include <string_view>

namespace heatsoak::derate::integer_form {
namespace {

constexpr std::string_view kPacked =
    R"(/* Data saved over power-off: signature of motor and guard (@CAP@_SIGNATURE), temperatures and CRC-32 (IEEE 802.3); little-endian. */
typedef enum {
  @_restored,        /* cooled for the elapsed time */
  @_time_unknown,    /* time without power unknown: each node takes its highest safe temperature */
  @_nothing_restored /* not saved, damaged or of another guard: starts as hot as the limit */
} @_restored_from;

static inline void @_pack(uint8_t *to, uint64_t word, int32_t size) {
  uint64_t left = word;
  int32_t i;
  for (i = 0; i < size; ++i) {
    to[i] = (uint8_t)(left & 0xffu);
    left >>= 8;
  }
}

static inline uint64_t @_unpack(const uint8_t *from, int32_t size) {
  uint64_t word = 0u;
  int32_t i;
  for (i = size - 1; i >= 0; --i) {
    word = (word << 8) | (uint64_t)from[i];
  }
  return word;
}

/* buffer: @CAP@_SAVED_SIZE bytes. Call it at regular intervals and when the supply voltage falls. */
static inline void @_save(const @_state *state, uint8_t *buffer) {
  int32_t node;
  @_pack(buffer, (state->started == @CAP@_STARTED) ? @CAP@_SIGNATURE : 0u, 4);
  for (node = 0; node < @NODES@; ++node) {
    @_pack(&buffer[4 + (8 * node)], (uint64_t)state->stored[node], 8);
  }
  @_pack(&buffer[@CAP@_SAVED_SIZE - 4], heatsoak_crc_32(buffer, @CAP@_SAVED_SIZE - 4), 4);
}

)";

constexpr std::string_view kCool = R"(/* Temperature rise of every node in one period from stored temperatures. */
static inline void @_stored_changes(const @_input *input, const int64_t *stored, int64_t *change) {
  int32_t state_C[@NODES@];
  int32_t node;
  for (node = 0; node < @NODES@; ++node) {
    state_C[node] = (int32_t)(stored[node] / @CAP@_STORED_PER_STATE);
  }
  @_changes(input, state_C, change);
}

/* Length of a cooling step at these temperatures: 1/5 of a lower bound of the shortest time constant. Its rate is at most the largest row
   sum of the absolute derivatives (Gershgorin). */
static inline int64_t @_cooling_step_us(const @_input *off, const int64_t *stored) {
  int64_t moved[@NODES@];
  int64_t change[@NODES@];
  int64_t moved_change[@NODES@];
  int64_t sum[@NODES@];
  int64_t fastest = 1;
  int32_t from;
  int32_t node;
  @_stored_changes(off, stored, change);
  for (node = 0; node < @NODES@; ++node) {
    moved[node] = stored[node];
    sum[node] = 0;
  }
  for (from = 0; from < @NODES@; ++from) {
    moved[from] += @CAP@_STORED_PER_K;
    @_stored_changes(off, moved, moved_change);
    moved[from] -= @CAP@_STORED_PER_K;
    for (node = 0; node < @NODES@; ++node) {
      const int64_t difference = moved_change[node] - change[node];
      sum[node] += (difference < 0) ? -difference : difference;
    }
  }
  for (node = 0; node < @NODES@; ++node) {
    fastest = (sum[node] > fastest) ? sum[node] : fastest;
  }
  return ((@CAP@_STORED_PER_K / 5) * @CAP@_PERIOD_US) / fastest;
}

/* One step of the classical method of Runge and Kutta, rounded up. peak: raised to the highest temperature of each node during the step;
   between its ends a node that first warms and then cools follows a parabola. */
static inline void @_cool_for(const @_input *off, int64_t step_us, int64_t *stored, int64_t *peak) {
  int64_t change[4][@NODES@];
  int64_t ahead[@NODES@];
  int32_t node;
  int32_t stage;
  @_stored_changes(off, stored, change[0]);
  for (stage = 1; stage < 4; ++stage) {
    const int64_t ahead_us = (stage == 3) ? step_us : (step_us / 2);
    for (node = 0; node < @NODES@; ++node) {
      ahead[node] = stored[node] + ((change[stage - 1][node] * ahead_us) / @CAP@_PERIOD_US) + 1;
    }
    @_stored_changes(off, ahead, change[stage]);
  }
  for (node = 0; node < @NODES@; ++node) {
    const int64_t first = change[0][node];
    const int64_t last = change[3][node];
    const int64_t mean = ((first + (2 * (change[1][node] + change[2][node])) + last) / 6) + 1;
    int64_t top = stored[node] + ((mean * step_us) / @CAP@_PERIOD_US) + 1;
    stored[node] = top;
    if ((first > 0) && (last < 0)) {
      top += (((-last * step_us) / @CAP@_PERIOD_US) / ((2 * (first - last)) / -last)) + 1;
    }
    peak[node] = (top > peak[node]) ? top : peak[node];
  }
}

/* Cools without current in the hottest air; elapsed_ms negative: for an unknown time, so that each node takes the highest temperature that
   it can have had. In the time beyond the largest number of steps, each node is at most as far above its resting temperature as the node
   that is farthest above. */
static inline void @_cool(int32_t elapsed_ms, int64_t *stored) {
  const @_input off = {0, 0, @CAP@_HOTTEST_AMBIENT_MC};
  const int64_t longest_us = @_cooling_step_us(&off, stored);
  const bool is_known = elapsed_ms >= 0;
  int64_t left_us = is_known ? ((int64_t)elapsed_ms * 1000) : INT64_C(1000000000000000);
  int64_t peak[@NODES@];
  int64_t above = 0;
  int32_t node;
  int32_t step;
  for (node = 0; node < @NODES@; ++node) {
    peak[node] = stored[node];
  }
  for (step = 0; (step < @CAP@_MOST_COOLING_STEPS) && (left_us > 0); ++step) {
    const int64_t step_us = (left_us < longest_us) ? left_us : longest_us;
    @_cool_for(&off, step_us, stored, peak);
    left_us -= step_us;
  }
  for (node = 0; node < @NODES@; ++node) {
    const int64_t this_above = stored[node] - @_resting[node];
    above = (this_above > above) ? this_above : above;
  }
  for (node = 0; node < @NODES@; ++node) {
    const int64_t later = (left_us > 0) ? (@_resting[node] + above) : stored[node];
    stored[node] = (is_known || (later > peak[node])) ? later : peak[node];
  }
}

)";

/// With saves at regular intervals the motor may have run since the last one. Assumes the highest load that the guard can have allowed.
constexpr std::string_view kUnsaved = R"(/* Worst-case heating: the driver's largest current at the accepted speed that heats most, up to
   the limit that the guard has kept, or up to the hottest node if that is hotter. No node cools. Negative: a very long time. */
static inline void @_heat(int32_t unsaved_ms, int64_t *stored) {
  int64_t most = ((int64_t)@CAP@_WINDING_LIMIT_MC * @CAP@_STORED_PER_K) / 1000;
  int64_t change[@NODES@];
  int64_t largest[@NODES@];
  /* 0.1 % more, because the period is rounded */
  int64_t left_us = (unsaved_ms >= 0) ? ((int64_t)unsaved_ms * 1001) : INT64_C(1000000000000000);
@EACH@  int32_t node;
  int32_t step;
  for (node = 0; node < @NODES@; ++node) {
    most = (stored[node] > most) ? stored[node] : most;
  }
  for (step = 0; (step < @CAP@_MOST_HEATING_STEPS) && (left_us > 0); ++step) {
    for (node = 0; node < @NODES@; ++node) {
      largest[node] = 0;
    }
@LARGEST@    for (node = 0; node < @NODES@; ++node) {
      stored[node] += largest[node];
      stored[node] = (stored[node] < most) ? stored[node] : most;
    }
    left_us -= @CAP@_PERIOD_US;
  }
  for (node = 0; (node < @NODES@) && (left_us > 0); ++node) {
    stored[node] = most;
  }
}

)";

constexpr std::string_view kRestore =
    R"(/* elapsed_ms: time without power, from a clock that kept running; negative or INT32_MAX (a converted infinity): unknown. After an
   unknown time each node takes the highest temperature that it can have had since the save, heat from the other nodes included, because
   power may have returned at once.
   unsaved_ms: longest time from the last save to the loss of power; 0 if the falling supply triggers the save; negative: very long.
   board_mC: lower bound of every node, because the motor was in the same surroundings; an implausible value counts as the hottest air. */
static inline @_restored_from @_restore(@_state *state, const uint8_t *buffer, int32_t elapsed_ms, int32_t unsaved_ms, int32_t board_mC) {
  const int64_t board = ((int64_t)board_mC * @CAP@_STORED_PER_K) / 1000;
  const int64_t hottest_air = ((int64_t)@CAP@_HOTTEST_AMBIENT_MC * @CAP@_STORED_PER_K) / 1000;
  const int64_t least = @_is_temperature(board) ? board : hottest_air;
  const int32_t known_ms = (elapsed_ms < INT32_MAX) ? elapsed_ms : -1;
  int32_t node;
  bool is_whole = (@_unpack(buffer, 4) == @CAP@_SIGNATURE) &&
                  (@_unpack(&buffer[@CAP@_SAVED_SIZE - 4], 4) == heatsoak_crc_32(buffer, @CAP@_SAVED_SIZE - 4));
  for (node = 0; node < @NODES@; ++node) {
    state->stored[node] = (int64_t)@_unpack(&buffer[4 + (8 * node)], 8);
    is_whole = is_whole && @_is_temperature(state->stored[node]);
  }
  if (!is_whole) {
    @_start(state, @CAP@_WINDING_LIMIT_MC);
    return @_nothing_restored;
  }
  if (unsaved_ms != 0) {
    @_heat(unsaved_ms, state->stored);
  }
  @_cool(known_ms, state->stored);
  for (node = 0; node < @NODES@; ++node) {
    state->stored[node] = (state->stored[node] > least) ? state->stored[node] : least;
  }
  state->started = @CAP@_STARTED;
  return (known_ms >= 0) ? @_restored : @_time_unknown;
}

)";

std::string counters(const HeatingInputs& inputs) {
  std::string text;
  for (const auto& [field, count] : inputs.looped) {
    text += fmt::format("  int32_t each_{};\n", field);
  }
  return text;
}

/// Generates the largest temperature rise of each node over the possible inputs.
std::string largest_changes(const HeatingInputs& inputs) {
  std::string indent = "    ";
  std::string text;
  std::string ends;
  for (const auto& [field, count] : inputs.looped) {
    text += fmt::format("{0}for (each_{1} = 0; each_{1} < {2}; ++each_{1}) {{\n", indent, field, count);
    ends = fmt::format("{}}}\n{}", indent, ends);
    indent += "  ";
  }
  return text + fmt::format(
                    "{0}const @_input on = {{{1}}};\n{0}@_stored_changes(&on, stored, change);\n"
                    "{0}for (node = 0; node < @NODES@; ++node) {{\n"
                    "{0}  largest[node] = (change[node] > largest[node]) ? change[node] : largest[node];\n{0}}}\n{2}",
                    indent, inputs.fields, ends);
}

}  // namespace

std::string integer_memory(const c_header::Words& guard_words, const HeatingInputs& inputs) {
  c_header::Words words{{"@EACH@", counters(inputs)}, {"@LARGEST@", largest_changes(inputs)}};
  words.insert(words.end(), guard_words.begin(), guard_words.end());
  std::string text;
  for (const std::string_view part : {kPacked, kCool, kUnsaved, kRestore}) {
    text += c_header::replaced(part, words);
  }
  return text;
}

}  // namespace heatsoak::derate::integer_form
