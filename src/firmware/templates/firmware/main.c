/* Example for an STM32F767: the control loop at the period of the drive core. Board functions: board.h. */
#include "board.h"
#include "heatsoak_core.h"

/* Start-up does not touch this memory, so after a reset by the watchdog the guard continues with its last temperatures. After a power
 * loss its contents are random: the core detects this by its check sums and begins as hot as the limit. */
__attribute__((section(".noinit"))) static heatsoak_core_state state;
/* Configuration that `state` belongs to: new firmware must not continue with the temperatures of another motor. */
__attribute__((section(".noinit"))) static uint32_t config_of_state;

static void read_inputs(heatsoak_core_input *input) {
  int wheel;
  heatsoak_core_clear(input);
  for (wheel = 0; wheel < HEATSOAK_CORE_WHEELS; ++wheel) {
    input->wheel_speed_rad_per_s[wheel] = board_wheel_speed_rad_per_s(wheel);
    input->motor_current_A[wheel] = board_motor_current_A(wheel);
    input->stator_C[wheel] = board_stator_C(wheel);
  }
  input->battery_V = board_battery_V();
  input->yaw_rate_rad_per_s = board_yaw_rate_rad_per_s();
  input->ambient_C = board_ambient_C();
  board_command(&input->command, &input->command_age_s);
}

static void start_core(void) {
  float body_C = HEATSOAK_CORE_NO_SAMPLE;
  const bool is_rested = board_motors_have_rested(&body_C);
  /* A damaged configuration needs no reaction here: every step then opens all bridges and reports it. */
  (void)heatsoak_core_start(&state, is_rested, body_C);
  config_of_state = HEATSOAK_CORE_CONFIG_CHECK_SUM;
}

int main(void) {
  heatsoak_core_input input;
  heatsoak_core_output output;
  /* The duration of a restart is unknown: for a gap of one second the guard assumes the largest current. */
  float elapsed_s = 1.0F;
  uint32_t last_us;
  int wheel;
  board_start();
  if (!board_has_kept_memory() || config_of_state != HEATSOAK_CORE_CONFIG_CHECK_SUM) {
    start_core();
    elapsed_s = HEATSOAK_CORE_PERIOD_S;
  }
  board_start_watchdog();
  board_wait_for_period();
  last_us = board_time_us();
  for (;;) {
    uint32_t now_us;
    read_inputs(&input);
    input.elapsed_s = elapsed_s;
    heatsoak_core_step(&state, &input, &output);
    for (wheel = 0; wheel < HEATSOAK_CORE_WHEELS; ++wheel) {
      board_set_wheel(wheel, output.pwm_ratio[wheel], output.is_open[wheel]);
    }
    board_report(&output);
    /* Fed here only: a loop that hangs, or an interrupt that never ends, stops the robot within HEATSOAK_CORE_WATCHDOG_US. */
    board_feed_watchdog();
    board_wait_for_period();
    now_us = board_time_us();
    elapsed_s = (float)(now_us - last_us) * 1e-6F;
    last_us = now_us;
  }
}
