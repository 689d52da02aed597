/* An instance of the FMU, for every version of FMI. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stddef.h>

#include "model.h"

typedef enum { mode_made, mode_initialization, mode_event, mode_stepping, mode_terminated, mode_failed } instance_mode;

/* The state that a rollback restores. Copied as bytes, except for the handling of events, which belongs to the instance. */
typedef struct {
  char token[MODEL_TOKEN_SIZE];
  model_events events;
  instance_mode mode;
  int is_event_done; /* in event mode: the event was ended, so that steps may follow */
  model_state model;
} instance_state;

/* All functions that return a text return 0, or the error message. */
void instance_make(instance_state *state, model_events events);
void instance_reset(instance_state *state);
const char *instance_begin(instance_state *state, double start_s);
const char *instance_end_initialization(instance_state *state);
const char *instance_terminate(instance_state *state);
/* Ends earlier only with events_end_step: value[at_time_s] is the time reached. *is_event: event mode must follow. */
const char *instance_step(instance_state *state, double current_s, double step_s, int *is_event);
const char *instance_enter_events(instance_state *state);
/* *has_next: *next_s is the time of the next event. */
const char *instance_end_event(instance_state *state, int *has_next, double *next_s);
const char *instance_enter_steps(instance_state *state);
const char *instance_set(instance_state *state, unsigned reference, model_type type, double value);
const char *instance_get(instance_state *state, unsigned reference, model_type type, double *value);
/* Copies the state to *kept, which the caller frees. If *kept is 0, it is allocated. */
const char *instance_keep(const instance_state *state, void **kept);
/* Restores the state from the bytes of a state. Bytes of another FMU are refused. */
const char *instance_restore(instance_state *state, const void *bytes, size_t size);
/* Writes the bytes of a kept state. */
const char *instance_serialize(const void *kept, void *bytes, size_t size);
/* Restores a kept state from its bytes. If *kept is 0, it is allocated as a copy of state and freed again if the bytes are refused. */
const char *instance_deserialize(const instance_state *state, const void *bytes, size_t size, void **kept);

#endif
