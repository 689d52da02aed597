/* Board functions that the firmware calls. board_default.c has weak versions of all of them, which compile, link and drive nothing: write
 * those of your board into board.c or board.cpp in this folder; the build finds the file, and `heatsoak generate core --force` keeps it. */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

#include "heatsoak_core.h"

/* Clocks, timers, ADC, PWM with all bridges open, sensors. Runs once, with interrupts enabled. */
void board_start(void);

/* Waits until the next control period begins; a timer interrupt every HEATSOAK_CORE_PERIOD_S ends the wait. */
void board_wait_for_period(void);

/* Free-running counter that wraps around. */
uint32_t board_time_us(void);

/* Samples as close to the beginning of the period as possible; HEATSOAK_CORE_NO_SAMPLE for a sensor that is not fitted or has failed.
 * speed: difference of the encoder's count over one period, or the driver's Hall speed; at the wheel, clockwise as seen from
 *        outside the robot.
 * current: of the bridge's shunt amplifier, mean over the PWM period, as torque-producing (equivalent DC) current. */
float board_wheel_speed_rad_per_s(int wheel);
float board_motor_current_A(int wheel);
float board_stator_C(int wheel);
float board_battery_V(void);
float board_yaw_rate_rad_per_s(void);
float board_ambient_C(void);

/* The last command that the radio received. `age_s`: time since then; increase it without limit while no command arrives. */
void board_command(heatsoak_core_command *command, float *age_s);

/* PWM ratio of the battery voltage, sign as the wheel's rotation. Open: all switches of the bridge off. */
void board_set_wheel(int wheel, float pwm_ratio, bool is_open);

/* For telemetry, after each step. Must not wait. */
void board_report(const heatsoak_core_output *output);

/* True if the motors have certainly rested until they are as warm as `body_C`: from a clock with a battery, or a sensor at the stators. */
bool board_motors_have_rested(float *body_C);

/* True after a reset by the watchdog or a fault, when the memory still holds the previous state. */
bool board_has_kept_memory(void);

/* The watchdog resets the controller, which opens the bridges, if it is not fed for HEATSOAK_CORE_WATCHDOG_US or less. It must not be
 * later: the guards count a gap for this long only. The default watchdog ends after 7.1 to 19.8 ms. */
void board_start_watchdog(void);
void board_feed_watchdog(void);

#endif
