// The drive core behind the C interface of heatsoak_core.h.
#include "heatsoak_core.h"

#include <cstddef>

#include "core_config.h"
#include "robot_core/drive_core.h"
#include "robot_core/guard_memory.h"

#ifdef __FAST_MATH__
#error "without -ffast-math: it removes the checks for values that are not a number"
#endif

namespace {

using robot_core::Command;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

static_assert(sizeof(State) == sizeof(heatsoak_core_state) && alignof(State) <= alignof(heatsoak_core_state));
static_assert(sizeof(Input) == sizeof(heatsoak_core_input) && alignof(Input) == alignof(heatsoak_core_input));
static_assert(sizeof(Output) == sizeof(heatsoak_core_output) && alignof(Output) == alignof(heatsoak_core_output));
static_assert(sizeof(Command) == sizeof(heatsoak_core_command));
static_assert(kCoreConfig.wheel_count == HEATSOAK_CORE_WHEELS && kCoreConfig.period_s == HEATSOAK_CORE_PERIOD_S);
static_assert(0.999999F * (HEATSOAK_CORE_WATCHDOG_US * 1e-6F) <= robot_core::kWatchdog_s);
static_assert(kCoreConfig.shadow_mode == (HEATSOAK_CORE_SHADOW_MODE == 1));
static_assert(kCoreConfig.check_sum == HEATSOAK_CORE_CONFIG_CHECK_SUM && robot_core::kMostWheels == HEATSOAK_CORE_MOST_WHEELS);

#define SAME_PLACE(c, cpp, member)                           \
  static_assert(offsetof(c, member) == offsetof(cpp, member) && \
                sizeof(static_cast<c *>(nullptr)->member) == sizeof(static_cast<cpp *>(nullptr)->member))

@SAME_PLACES@
#undef SAME_PLACE

static_assert(HEATSOAK_CORE_COAST == int(Mode::coast) && HEATSOAK_CORE_BRAKE == int(Mode::brake));
static_assert(HEATSOAK_CORE_BODY_VELOCITY == int(Mode::body_velocity) && HEATSOAK_CORE_WHEEL_SPEED == int(Mode::wheel_speed));
static_assert(HEATSOAK_CORE_WHEEL_TORQUE == int(Mode::wheel_torque) && HEATSOAK_CORE_POSE_TARGET == int(Mode::pose_target));
@SAME_REASONS@
State &state_in(heatsoak_core_state *state) { return *reinterpret_cast<State *>(state->bytes); }

inline void step(const robot_core::Config &config, heatsoak_core_state *state, const heatsoak_core_input *input,
                 heatsoak_core_output *output) {
  const Output out = robot_core::step(config, state_in(state), __builtin_bit_cast(Input, *input));
  *output = __builtin_bit_cast(heatsoak_core_output, out);
}

}  // namespace

extern "C" {

bool heatsoak_core_start(heatsoak_core_state *state, bool is_rested, float body_C) {
  robot_core::StartUp start_up;
  start_up.is_rested = is_rested;
  start_up.body_C = body_C;
  return robot_core::start(kCoreConfig, state_in(state), start_up);
}

bool heatsoak_core_restore(heatsoak_core_state *state, const heatsoak_core_state *saved, float elapsed_s, float board_C) {
  return robot_core::restore(kCoreConfig, state_in(state), *reinterpret_cast<const State *>(saved->bytes), elapsed_s, board_C);
}

void heatsoak_core_clear(heatsoak_core_input *input) {
  const Input none;
  *input = __builtin_bit_cast(heatsoak_core_input, none);
}

void heatsoak_core_step(heatsoak_core_state *state, const heatsoak_core_input *input, heatsoak_core_output *output) {
  step(kCoreConfig, state, input, output);
}

heatsoak_core_shadow heatsoak_core_read_shadow(const heatsoak_core_state *state) {
  const State &counted = *reinterpret_cast<const State *>(state->bytes);
  return {counted.shadow_steps, counted.shadow_deficit_A_s};
}

void heatsoak_core_step_with_planner(heatsoak_core_state *state, const heatsoak_core_input *input, heatsoak_core_output *output) {
  step(kCoreConfigWithPlanner, state, input, output);
}
}
