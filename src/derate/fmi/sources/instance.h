/* An instance of the FMU, for every version of FMI. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stddef.h>

#include "model.h"

typedef enum { mode_made, mode_initialization, mode_stepping, mode_terminated, mode_failed } instance_mode;

/* The state that a rollback restores. Copied as bytes. */
typedef struct {
  char token[MODEL_TOKEN_SIZE];
  instance_mode mode;
  model_state model;
} instance_state;

/* All functions that return a text return 0, or the error message. */
void instance_reset(instance_state *state);
const char *instance_begin(instance_state *state, double start_s);
const char *instance_end_initialization(instance_state *state);
const char *instance_terminate(instance_state *state);
const char *instance_step(instance_state *state, double current_s, double step_s);
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
