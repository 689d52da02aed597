/* Weak board functions for an STM32F767 that runs on its internal oscillator of 16 MHz: timer, time and watchdog work, sensors have no
 * samples, and no bridge is driven. Addresses: STM32F76xxx reference manual (RM0410) and Armv7-M architecture reference manual. */
#include "board.h"

#define WEAK __attribute__((weak))
#define REGISTER(address) (*(volatile uint32_t *)(address))

#define RCC_CSR REGISTER(0x40023874u)
#define RCC_CSR_RMVF (1u << 24)
#define RCC_CSR_PORRSTF (1u << 27)
#define IWDG_KR REGISTER(0x40003000u)
#define IWDG_PR REGISTER(0x40003004u)
#define IWDG_RLR REGISTER(0x40003008u)
#define IWDG_SR REGISTER(0x4000300Cu)
#define SYST_CSR REGISTER(0xE000E010u)
#define SYST_RVR REGISTER(0xE000E014u)
#define SYST_CVR REGISTER(0xE000E018u)
#define DEMCR REGISTER(0xE000EDFCu)
#define DWT_CTRL REGISTER(0xE0001000u)
#define DWT_CYCCNT REGISTER(0xE0001004u)
#define DWT_LAR REGISTER(0xE0001FB0u)

#define CLOCK_PER_US 16u /* internal oscillator; 216 with the PLL */

/* Independent watchdog: its oscillator of 32 kHz is only accurate to 17 to 47 kHz (data sheet DS11532), so it ends after 7.1 to 19.8 ms. */
#define WATCHDOG_RELOAD 83u
#define WATCHDOG_CYCLES (4u * (WATCHDOG_RELOAD + 1u)) /* of the oscillator; prescaler 4 */
#define SLOWEST_KHZ 17u
#define FASTEST_KHZ 47u
_Static_assert(WATCHDOG_CYCLES * 1000u <= SLOWEST_KHZ * HEATSOAK_CORE_WATCHDOG_US, "the watchdog is slower than the guards assume");
_Static_assert(WATCHDOG_CYCLES * 1000u >= 2u * FASTEST_KHZ * HEATSOAK_CORE_PERIOD_US,
               "this watchdog may end within two periods: use a more accurate one of the same time");

static volatile uint32_t periods;

void SysTick_Handler(void);
WEAK void SysTick_Handler(void) { ++periods; }

WEAK void board_start(void) {
  /* Cycle counter for board_time_us(); a Cortex-M7 has to unlock it. */
  DEMCR |= 1u << 24;
  DWT_LAR = 0xC5ACCE55u;
  DWT_CYCCNT = 0;
  DWT_CTRL |= 1u;
  SYST_RVR = HEATSOAK_CORE_PERIOD_US * CLOCK_PER_US - 1u;
  SYST_CVR = 0;
  SYST_CSR = 7u; /* processor clock, interrupt, on */
}

WEAK void board_wait_for_period(void) {
  static uint32_t seen;
  /* A masked interrupt still ends wfi: one that comes between the test and wfi is not missed. */
  __asm__ volatile("cpsid i" ::: "memory");
  while (periods == seen) {
    __asm__ volatile("wfi\n\tcpsie i\n\tisb\n\tcpsid i" ::: "memory");
  }
  seen = periods;
  __asm__ volatile("cpsie i" ::: "memory");
}

WEAK uint32_t board_time_us(void) {
  static uint32_t last_cycles;
  static uint32_t rest_cycles;
  static uint32_t time_us;
  const uint32_t cycles = DWT_CYCCNT;
  rest_cycles += cycles - last_cycles;
  last_cycles = cycles;
  time_us += rest_cycles / CLOCK_PER_US;
  rest_cycles %= CLOCK_PER_US;
  return time_us;
}

WEAK float board_wheel_speed_rad_per_s(int wheel) {
  (void)wheel;
  return HEATSOAK_CORE_NO_SAMPLE;
}

WEAK float board_motor_current_A(int wheel) {
  (void)wheel;
  return HEATSOAK_CORE_NO_SAMPLE;
}

WEAK float board_stator_C(int wheel) {
  (void)wheel;
  return HEATSOAK_CORE_NO_SAMPLE;
}

WEAK float board_battery_V(void) { return HEATSOAK_CORE_NO_SAMPLE; }
WEAK float board_yaw_rate_rad_per_s(void) { return HEATSOAK_CORE_NO_SAMPLE; }
WEAK float board_ambient_C(void) { return HEATSOAK_CORE_NO_SAMPLE; }

WEAK void board_command(heatsoak_core_command *command, float *age_s) {
  command->mode = HEATSOAK_CORE_COAST;
  *age_s = 0.0F;
}

WEAK void board_set_wheel(int wheel, float pwm_ratio, bool is_open) {
  (void)wheel;
  (void)pwm_ratio;
  (void)is_open;
}

WEAK void board_report(const heatsoak_core_output *output) { (void)output; }

WEAK bool board_motors_have_rested(float *body_C) {
  (void)body_C;
  return false;
}

WEAK bool board_has_kept_memory(void) {
  const bool has_lost_power = (RCC_CSR & RCC_CSR_PORRSTF) != 0;
  RCC_CSR |= RCC_CSR_RMVF;
  return !has_lost_power;
}

WEAK void board_start_watchdog(void) {
  IWDG_KR = 0xCCCCu; /* start: switches its oscillator on */
  IWDG_KR = 0x5555u; /* allow changes */
  IWDG_PR = 0u;      /* prescaler 4 */
  IWDG_RLR = WATCHDOG_RELOAD;
  while (IWDG_SR != 0u) {
  } /* until the oscillator's clock has taken both over */
  IWDG_KR = 0xAAAAu;
}

WEAK void board_feed_watchdog(void) { IWDG_KR = 0xAAAAu; }
