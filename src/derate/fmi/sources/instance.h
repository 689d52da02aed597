/* What an instance of the FMU is, whatever the version of FMI. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stddef.h>

#include "model.h"

typedef enum { mode_made, mode_initialization, mode_stepping, mode_terminated, mode_failed } instance_mode;

/* All that a rollback has to bring back. Copied as bytes. */
typedef struct {
  char token[MODEL_TOKEN_SIZE];
  instance_mode mode;
  model_state model;
} instance_state;

/* All functions that return a text return 0, or what is wrong. */
void instance_reset(instance_state *state);
const char *instance_begin(instance_state *state, double start_s);
const char *instance_end_initialization(instance_state *state);
const char *instance_terminate(instance_state *state);
const char *instance_step(instance_state *state, double current_s, double step_s);
const char *instance_set(instance_state *state, unsigned reference, model_type type, double value);
const char *instance_get(instance_state *state, unsigned reference, model_type type, double *value);
/* The caller frees it. 0 without memory. */
instance_state *instance_copy(const instance_state *state);
/* From the bytes of a state; another FMU's are refused. */
const char *instance_restore(instance_state *state, const void *bytes, size_t size);

#endif
