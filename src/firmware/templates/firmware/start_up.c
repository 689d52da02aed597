/* Start-up of an STM32F767: vector table, FPU, contents of .data and .bss, then main(). Handlers are weak: define one of the same name, or
 * put an interrupt's into `vectors`, to replace it. */
#include <stdint.h>

int main(void);

/* From the linker script; only their addresses are meaningful. */
extern uint32_t data_begin[];
extern uint32_t data_end[];
extern const uint32_t data_contents[];
extern uint32_t bss_begin[];
extern uint32_t bss_end[];
extern uint32_t stack_end[];

void Reset_Handler(void);
void Default_Handler(void);
void SysTick_Handler(void);
void HardFault_Handler(void) __attribute__((weak, alias("Default_Handler")));
void NMI_Handler(void) __attribute__((weak, alias("Default_Handler")));

#define CPACR (*(volatile uint32_t *)0xE000ED88u) /* Coprocessor Access Control Register */
#define VTOR (*(volatile uint32_t *)0xE000ED08u)  /* Vector Table Offset Register */

/* The watchdog ends this with a reset. */
void Default_Handler(void) {
  for (;;) {
  }
}

typedef void (*handler)(void);

#define INTERRUPTS 110 /* of the STM32F76x */

__attribute__((section(".vectors"), used)) static const struct {
  uint32_t *stack;
  handler exceptions[15];
  handler interrupts[INTERRUPTS];
} vectors = {stack_end,
             {Reset_Handler, NMI_Handler, HardFault_Handler, Default_Handler, Default_Handler, Default_Handler, 0, 0, 0, 0,
              Default_Handler, Default_Handler, 0, Default_Handler, SysTick_Handler},
             {[0 ... INTERRUPTS - 1] = Default_Handler}};

/* Not inlined: no floating-point instruction may be moved before the FPU is enabled. */
__attribute__((noinline, noreturn)) static void run(void) {
  const uint32_t *from = data_contents;
  uint32_t *to;
  for (to = data_begin; to < data_end; ++to) {
    *to = *from++;
  }
  for (to = bss_begin; to < bss_end; ++to) {
    *to = 0;
  }
  (void)main();
  for (;;) {
  }
}

void Reset_Handler(void) {
  VTOR = (uint32_t)(uintptr_t)&vectors;
  CPACR |= 0xFu << 20; /* full access to the FPU */
  __asm__ volatile("dsb\n\tisb" ::: "memory");
  run();
}
