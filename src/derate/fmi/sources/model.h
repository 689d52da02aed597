/* Interface between the FMI functions and a model. Every variable has one number for both versions of FMI, and one double for its value: a
   Boolean is 0 or 1, an enumeration its item. */
#ifndef MODEL_H
#define MODEL_H

#include "model_data.h"

typedef enum { kind_independent, kind_input, kind_parameter, kind_output, kind_constant } model_kind;
typedef enum { type_real, type_boolean, type_enumeration } model_type;

typedef struct {
  model_kind kind;
  model_type type;
  double value; /* at the start */
} model_variable;

typedef struct {
  double value[MODEL_VARIABLES];
  model_part part;
} model_state;

/* In the order of their numbers. */
extern const model_variable model_variables[MODEL_VARIABLES];

/* Where a step handles its events: inside, as if there were none; or in event mode, after the whole step or after a step that ends at the
   first event. */
typedef enum { events_inside, events_after_step, events_end_step } model_events;

/* Calculates the outputs from start values and inputs at the start time. Returns 0, or the error message. */
const char *model_begin(model_state *state);
/* Simulates from value[at_time_s] to `until_s`, or to the event, with held inputs; sets the time. Sets *is_event to 1 if event mode must
   follow, and leaves it alone otherwise. Returns 0, or the error message. */
const char *model_step(model_state *state, double until_s, model_events events, int *is_event);
/* Calculates the discrete outputs of event mode from the inputs of the moment. */
void model_event_outputs(model_state *state);
/* Ends an event. Returns 1 and sets *next_s if the time of the next event is known, else 0. */
int model_end_event(model_state *state, double *next_s);

#endif
