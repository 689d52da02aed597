// Test of the generated core on the host: `self_test` checks it, `self_test replay INPUTS OUTPUTS` runs recorded inputs through it.
//
// INPUTS: a sequence of heatsoak_core_input, as in memory. OUTPUTS: for each input a heatsoak_core_output and the 64 bits of
// FNV-1a (Fowler, Noll, Vo) over the bytes of the state after it.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "heatsoak_core.h"

namespace {

int failures = 0;

void check(bool holds, const char *what) {
  if (!holds) {
    std::printf("FAILED: %s\n", what);
    ++failures;
  }
}

heatsoak_core_input standing() {
  heatsoak_core_input input;
  heatsoak_core_clear(&input);
  for (int i = 0; i < HEATSOAK_CORE_MOST_WHEELS; ++i) {
    input.wheel_speed_rad_per_s[i] = 0.0F;
    input.motor_current_A[i] = 0.0F;
  }
  input.battery_V = @BATTERY_V@;
  input.yaw_rate_rad_per_s = 0.0F;
  input.ambient_C = 25.0F;
  input.elapsed_s = HEATSOAK_CORE_PERIOD_S;
  return input;
}

heatsoak_core_state rested() {
  heatsoak_core_state state;
  std::memset(&state, 0, sizeof state);
  check(heatsoak_core_start(&state, true, 25.0F), "the configuration has its check sum and is possible");
  return state;
}

bool all_open(const heatsoak_core_output &output) {
  bool open = true;
  for (int i = 0; i < HEATSOAK_CORE_WHEELS; ++i) {
    open = open && output.is_open[i];
  }
  return open;
}

void drives_when_commanded() {
  heatsoak_core_state state = rested();
  heatsoak_core_input input = standing();
  heatsoak_core_output output;
  input.command.mode = HEATSOAK_CORE_BODY_VELOCITY;
  input.command.velocity.x = 0.5F;
  float largest = 0.0F;
  bool is_bounded = true;
  for (int i = 0; i < 20; ++i) {
    heatsoak_core_step(&state, &input, &output);
    for (int wheel = 0; wheel < HEATSOAK_CORE_WHEELS; ++wheel) {
      largest = std::fmax(largest, std::fabs(output.pwm_ratio[wheel]));
      is_bounded = is_bounded && std::fabs(output.pwm_ratio[wheel]) <= 1.0F && std::isfinite(output.voltage_V[wheel]);
    }
  }
  check(largest > 0.005F && !all_open(output), "a commanded velocity puts voltage on the wheels");
  check(is_bounded, "PWM ratios stay between -1 and 1");
  check(output.winding_C[0] < 60.0F && output.allowed_current_A[0] > 0.0F, "a rested motor may carry current");
}

void opens_without_command() {
  heatsoak_core_state state = rested();
  heatsoak_core_input input = standing();
  heatsoak_core_output output;
  input.command.mode = HEATSOAK_CORE_BODY_VELOCITY;
  input.command.velocity.x = 0.5F;
  input.command_age_s = 10.0F;
  heatsoak_core_step(&state, &input, &output);
  check(all_open(output) && output.robot_reason == HEATSOAK_CORE_COMMAND_STALE, "an old command opens the bridges of a standing robot");
}

void recovers_from_damage() {
  heatsoak_core_state state = rested();
  const heatsoak_core_input input = standing();
  heatsoak_core_output output;
  heatsoak_core_step(&state, &input, &output);
  check(output.robot_reason == HEATSOAK_CORE_NONE, "no fault with sound samples");
  state.bytes[100] = static_cast<unsigned char>(state.bytes[100] ^ 4U);
  heatsoak_core_step(&state, &input, &output);
  check(output.robot_reason == HEATSOAK_CORE_STATE_CORRUPTED, "a flipped bit of the state is found");
  check(output.winding_C[0] > 60.0F, "the guard of a damaged state begins hot");
}

void restores_after_power_loss() {
  heatsoak_core_state saved = rested();
  const heatsoak_core_input input = standing();
  heatsoak_core_output output;
  heatsoak_core_step(&saved, &input, &output);
  const float before_C = output.winding_C[0];
  heatsoak_core_state state;
  std::memset(&state, 0, sizeof state);
  heatsoak_core_start(&state, false, HEATSOAK_CORE_NO_SAMPLE);
  heatsoak_core_step(&state, &input, &output);
  check(output.winding_C[0] > 60.0F, "without a copy the guard begins hot");
  heatsoak_core_start(&state, false, HEATSOAK_CORE_NO_SAMPLE);
  check(heatsoak_core_restore(&state, &saved, 1.0F, 25.0F), "a copy is restored");
  heatsoak_core_step(&state, &input, &output);
  check(std::fabs(output.winding_C[0] - before_C) < 5.0F, "the guard continues with the temperatures of the copy");
  for (unsigned char &byte : saved.bytes) {
    byte = static_cast<unsigned char>(byte ^ 4U);
  }
  heatsoak_core_start(&state, false, HEATSOAK_CORE_NO_SAMPLE);
  check(!heatsoak_core_restore(&state, &saved, 1.0F, 25.0F), "a damaged copy is refused");
}

void needs_a_planner_for_poses() {
  heatsoak_core_input input = standing();
  heatsoak_core_output output;
  input.command.mode = HEATSOAK_CORE_POSE_TARGET;
  input.command.pose.x = 1.0F;
  input.pose = {0.0F, 0.0F, 0.0F};
  heatsoak_core_state state = rested();
  heatsoak_core_step(&state, &input, &output);
  check(output.robot_reason == HEATSOAK_CORE_POSE_INVALID, "without planner a pose target is refused");
  state = rested();
  for (int i = 0; i < 20; ++i) {
    heatsoak_core_step_with_planner(&state, &input, &output);
  }
  check(output.robot_reason == HEATSOAK_CORE_NONE && !all_open(output), "with the planner it is followed");
}

/// A guard at its limit allows no current. In shadow mode it counts what it would take away, and the current flows.
void limits_or_counts() {
  heatsoak_core_state state;
  std::memset(&state, 0, sizeof state);
  heatsoak_core_start(&state, false, HEATSOAK_CORE_NO_SAMPLE);
  heatsoak_core_input input = standing();
  heatsoak_core_output output;
  input.command.mode = HEATSOAK_CORE_WHEEL_TORQUE;
  float largest_V = 0.0F;
  for (float &torque_Nm : input.command.wheel_torque_Nm) {
    torque_Nm = 0.02F;
  }
  for (int i = 0; i < 20; ++i) {
    heatsoak_core_step(&state, &input, &output);
    for (const float voltage_V : output.voltage_V) {
      largest_V = std::fmax(largest_V, std::fabs(voltage_V));
    }
  }
  const heatsoak_core_shadow shadow = heatsoak_core_read_shadow(&state);
#if HEATSOAK_CORE_SHADOW_MODE
  check(shadow.steps > 0 && shadow.deficit_A_s > 0.0F, "shadow mode counts what a hot guard would limit");
  check(largest_V > 0.01F, "shadow mode limits nothing");
#else
  check(shadow.steps == 0 && shadow.deficit_A_s == 0.0F, "without shadow mode nothing is counted");
  check(largest_V < 0.01F, "a guard at its limit takes the current away");
#endif
}

std::uint64_t digest(const heatsoak_core_state &state) {
  std::uint64_t sum = 14695981039346656037U;
  for (const unsigned char byte : state.bytes) {
    sum = (sum ^ byte) * 1099511628211U;
  }
  return sum;
}

int replay(const char *inputs, const char *outputs) {
  std::FILE *const from = std::fopen(inputs, "rb");
  std::FILE *const to = std::fopen(outputs, "wb");
  if (from == nullptr || to == nullptr) {
    std::printf("%s cannot be opened\n", from == nullptr ? inputs : outputs);
    return 2;
  }
  heatsoak_core_state state = rested();
  heatsoak_core_input input;
  heatsoak_core_output output;
  while (std::fread(&input, sizeof input, 1, from) == 1) {
    heatsoak_core_step_with_planner(&state, &input, &output);
    std::fwrite(&output, sizeof output, 1, to);
    const std::uint64_t sum = digest(state);
    std::fwrite(&sum, sizeof sum, 1, to);
  }
  std::fclose(from);
  return std::fclose(to) == 0 && failures == 0 ? 0 : 2;
}

}  // namespace

int main(int count, char **words) {
  if (count == 4 && std::strcmp(words[1], "replay") == 0) {
    return replay(words[2], words[3]);
  }
  drives_when_commanded();
  opens_without_command();
  recovers_from_damage();
  restores_after_power_loss();
  needs_a_planner_for_poses();
  limits_or_counts();
  std::printf(failures == 0 ? "the generated core passes its self-test\n" : "%d checks failed\n", failures);
  return failures == 0 ? 0 : 1;
}
