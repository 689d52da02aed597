/* The firmware's guard: the exported header, called once a period as the firmware does. */
#include <math.h>
#include <string.h>

#include "model.h"

/* treats a communication point that is a rounding error early as the time of the call */
static double due_calls(const model_state *state, double at_s) { return floor((at_s - state->part.start_s) / GUARD_PERIOD_S + 1e-6); }

static double next_call_s(const model_state *state) { return state->part.start_s + (state->part.calls + 1.0) * GUARD_PERIOD_S; }

static void show(model_state *state, guard_output output) {
  state->value[at_allowed_current_A] = (double)output.allowed_current_A;
  state->value[at_guarded_winding_C] = (double)output.guarded_winding_C;
  state->value[at_nominal_winding_C] = (double)output.nominal_winding_C;
  state->value[at_reason] = (double)output.reason;
  state->value[at_is_limiting] = output.reason != guard_full ? 1.0 : 0.0;
}

/* Calls the guard until `calls`. Outputs are those of the last call. */
static void call_until(model_state *state, double calls) {
  guard_input input;
  guard_read(state->value, &input);
  for (; state->part.calls < calls; state->part.calls += 1.0) {
    show(state, guard_step(&state->part.guard, &input));
  }
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

const char *model_step(model_state *state, double until_s, model_events events, int *is_event) {
  const double due = due_calls(state, until_s);
  if (events == events_inside) {
    call_until(state, due);
  } else if (due > state->part.calls) {
    /* the last call that is due waits for event mode, where it sees the inputs of its own moment */
    *is_event = 1;
    if (events == events_after_step) {
      call_until(state, due - 1.0);
    } else if (due > state->part.calls + 1.0 || next_call_s(state) < until_s - 1e-6 * GUARD_PERIOD_S) {
      until_s = next_call_s(state);
    }
  }
  state->value[at_time_s] = until_s;
  return 0;
}

void model_event_outputs(model_state *state) {
  if (due_calls(state, state->value[at_time_s]) > state->part.calls) {
    model_state tried;
    memcpy(&tried, state, sizeof tried);
    call_until(&tried, tried.part.calls + 1.0);
    memcpy(state->value, tried.value, sizeof tried.value);
  }
}

int model_end_event(model_state *state, double *next_s) {
  call_until(state, due_calls(state, state->value[at_time_s]));
  *next_s = next_call_s(state);
  return 1;
}
