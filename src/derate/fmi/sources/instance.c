#include "instance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void instance_reset(instance_state *state) { instance_make(state, state->events); }

void instance_make(instance_state *state, model_events events) {
  int i;
  /* also sets the padding between the members: equal states have equal bytes */
  memset(state, 0, sizeof *state);
  strcpy(state->token, MODEL_TOKEN);
  state->events = events;
  for (i = 0; i < MODEL_VARIABLES; ++i) {
    state->model.value[i] = model_variables[i].value;
  }
}

const char *instance_begin(instance_state *state, double start_s) {
  if (state->mode != mode_made) {
    return "initialization mode is entered once, after instantiation or reset";
  }
  if (!isfinite(start_s)) {
    return "the start time is not a number";
  }
  state->mode = mode_initialization;
  state->model.value[at_time_s] = start_s;
  return model_begin(&state->model);
}

const char *instance_end_initialization(instance_state *state) {
  if (state->mode != mode_initialization) {
    return "initialization mode was not entered";
  }
  state->mode = state->events == events_inside ? mode_stepping : mode_event;
  state->is_event_done = 0;
  return model_begin(&state->model);
}

const char *instance_terminate(instance_state *state) {
  if (state->mode != mode_stepping && state->mode != mode_event) {
    return "only a running simulation can be terminated";
  }
  state->mode = mode_terminated;
  return 0;
}

/* The caller frees it. Returns 0 if out of memory. */
static instance_state *copy_of(const instance_state *state) {
  instance_state *const copy = malloc(sizeof *copy);
  if (copy) {
    memcpy(copy, state, sizeof *copy);
  }
  return copy;
}

const char *instance_step(instance_state *state, double current_s, double step_s, int *is_event) {
  const double now_s = state->model.value[at_time_s];
  instance_state *next;
  const char *problem;
  if (state->mode != mode_stepping) {
    return state->mode == mode_event
               ? "a step needs step mode: end the event and enter step mode first"
               : "a step needs a running simulation: after initialization, before termination and without an earlier error";
  }
  if (!(fabs(current_s - now_s) <= 1e-9 * (1.0 + fabs(now_s)))) {
    return "the step does not begin at the end of the last one; expected that time, or that of a state that was set before";
  }
  if (!(step_s > 0.0) || !isfinite(step_s)) {
    return "the step size is not above 0 s";
  }
  next = copy_of(state);
  if (!next) {
    return "out of memory";
  }
  problem = model_step(&next->model, current_s + step_s, state->events, is_event);
  if (problem) {
    state->mode = mode_failed;
  } else {
    memcpy(state, next, sizeof *state);
  }
  free(next);
  return problem;
}

const char *instance_enter_events(instance_state *state) {
  if (state->events == events_inside) {
    return "the importer announced no event mode at instantiation";
  }
  if (state->mode != mode_stepping) {
    return "event mode is entered from step mode";
  }
  state->mode = mode_event;
  state->is_event_done = 0;
  return 0;
}

const char *instance_end_event(instance_state *state, int *has_next, double *next_s) {
  if (state->mode != mode_event) {
    return "discrete states are updated in event mode";
  }
  *has_next = model_end_event(&state->model, next_s);
  state->is_event_done = 1;
  return 0;
}

const char *instance_enter_steps(instance_state *state) {
  if (state->mode != mode_event || !state->is_event_done) {
    return "step mode is entered from event mode, after the discrete states were updated";
  }
  state->mode = mode_stepping;
  return 0;
}

const char *instance_set(instance_state *state, unsigned reference, model_type type, double value) {
  if (reference >= MODEL_VARIABLES || model_variables[reference].type != type) {
    return "there is no variable of this type and value reference";
  }
  if (state->mode == mode_terminated || state->mode == mode_failed) {
    return "the simulation has ended";
  }
  if (model_variables[reference].kind != kind_input && model_variables[reference].kind != kind_parameter) {
    return "only inputs and parameters can be set";
  }
  if (model_variables[reference].kind == kind_parameter && (state->mode == mode_stepping || state->mode == mode_event)) {
    return "a parameter is fixed once the simulation runs";
  }
  if (!isfinite(value) && !(MODEL_TAKES_UNKNOWN && model_variables[reference].kind == kind_input)) {
    return "the value is not a finite number";
  }
  state->model.value[reference] = value;
  return 0;
}

const char *instance_get(instance_state *state, unsigned reference, model_type type, double *value) {
  const char *problem = 0;
  if (reference >= MODEL_VARIABLES || model_variables[reference].type != type) {
    return "there is no variable of this type and value reference";
  }
  if (state->mode == mode_initialization && model_variables[reference].kind == kind_output) {
    /* parameters may have been set since then */
    problem = model_begin(&state->model);
  }
  if (state->mode == mode_event && model_variables[reference].kind == kind_output) {
    /* inputs may have been set since then */
    model_event_outputs(&state->model);
  }
  *value = state->model.value[reference];
  return problem;
}

const char *instance_restore(instance_state *state, const void *bytes, size_t size) {
  const model_events events = state->events;
  if (size != sizeof *state || memcmp(bytes, MODEL_TOKEN, sizeof MODEL_TOKEN) != 0) {
    return "the bytes are not a state of this FMU";
  }
  if (((const instance_state *)bytes)->mode == mode_event && state->events == events_inside) {
    return "the state is one of event mode, which the importer did not announce at instantiation";
  }
  memcpy(state, bytes, size);
  state->events = events;
  return 0;
}

const char *instance_keep(const instance_state *state, void **kept) {
  if (*kept) {
    memcpy(*kept, state, sizeof *state);
  } else {
    *kept = copy_of(state);
  }
  return *kept ? 0 : "out of memory";
}

const char *instance_serialize(const void *kept, void *bytes, size_t size) {
  if (size < sizeof(instance_state)) {
    return "the buffer for the state is too small";
  }
  memcpy(bytes, kept, sizeof(instance_state));
  return 0;
}

const char *instance_deserialize(const instance_state *state, const void *bytes, size_t size, void **kept) {
  instance_state *const made = *kept ? *kept : copy_of(state);
  const char *const problem = made ? instance_restore(made, bytes, size) : "out of memory";
  if (problem && made && !*kept) {
    free(made);
  } else {
    *kept = made;
  }
  return problem;
}
