/* The firmware's guard: the exported header, called once a period as the firmware does. */
#include <math.h>
#include <string.h>

#include "model.h"

static void show(model_state *state, guard_output output) {
  state->value[at_allowed_current_A] = (double)output.allowed_current_A;
  state->value[at_guarded_winding_C] = (double)output.guarded_winding_C;
  state->value[at_nominal_winding_C] = (double)output.nominal_winding_C;
  state->value[at_reason] = (double)output.reason;
}

const char *model_begin(model_state *state) {
  guard_state tried;
  guard_input input;
  guard_start(&state->part.guard, (float)state->value[at_start_C]);
  state->part.calls = 0.0;
  state->part.start_s = state->value[at_time_s];
  /* outputs of the first call */
  memcpy(&tried, &state->part.guard, sizeof tried);
  guard_read(state->value, &input);
  show(state, guard_step(&tried, &input));
  return 0;
}

const char *model_step(model_state *state, double until_s) {
  /* treats a communication point that is a rounding error early as the time of the call */
  const double due_calls = floor((until_s - state->part.start_s) / GUARD_PERIOD_S + 1e-6);
  guard_input input;
  guard_read(state->value, &input);
  for (; state->part.calls < due_calls; state->part.calls += 1.0) {
    show(state, guard_step(&state->part.guard, &input));
  }
  state->value[at_time_s] = until_s;
  return 0;
}
