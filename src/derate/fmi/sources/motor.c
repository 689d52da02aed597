/* A motor's thermal network with its effects, in double precision. Method: Bogacki and Shampine 1989, third order with an embedded second
   order for the step. */
#include <math.h>
#include <string.h>

#include "model.h"

/* K per step; the model is compared to a tenth of a kelvin */
#define TOLERANCE_K 1e-4
#define MOST_STEPS 10000000L
/* a crossing of a limit is located to this */
#define LOCATED_S 1e-6

/* dT/dt of every node, from inputs and temperatures (model_data.c). */
void motor_rates(const double *value, const double *state_C, double *rate_K_per_s);

static int is_over(const double *state_C) {
  return state_C[0] > MODEL_WINDING_LIMIT_C || (MODEL_STATOR_LIMIT_C > 0.0 && state_C[1] > MODEL_STATOR_LIMIT_C);
}

void model_event_outputs(model_state *state) {
  state->value[at_over_limit] = (double)is_over(state->value + MODEL_FIRST_NODE);
  state->value[at_limit_crossing_s] = state->part.crossing_s;
}

int model_end_event(model_state *state, double *next_s) {
  (void)next_s; /* a limit is crossed when the temperature wants it */
  model_event_outputs(state);
  return 0;
}

static const char *outputs(model_state *state, model_events events) {
  int node;
  for (node = 0; node < MODEL_NODES; ++node) {
    if (!isfinite(state->value[MODEL_FIRST_NODE + node])) {
      return "a temperature is not finite: the motor is far above its limit, or an input is not finite";
    }
  }
  if (state->value[MODEL_FIRST_NODE] > state->value[at_winding_peak_C]) {
    state->value[at_winding_peak_C] = state->value[MODEL_FIRST_NODE];
  }
  if (events == events_inside) {
    model_event_outputs(state);
  }
  return 0;
}

const char *model_begin(model_state *state) {
  int node;
  for (node = 0; node < MODEL_NODES; ++node) {
    state->value[MODEL_FIRST_NODE + node] = state->value[MODEL_FIRST_START + node];
  }
  state->value[at_winding_peak_C] = state->value[MODEL_FIRST_NODE];
  state->part.step_s = 0.0;
  state->part.crossing_s = MODEL_NO_CROSSING_S;
  return outputs(state, events_inside);
}

/* One attempt; returns its error per tolerance. `first_rate` is the rate at `from_C`, `last_rate` becomes that at `to_C`. */
static double attempt(const double *value, double step_s, const double *from_C, const double *first_rate, double *to_C, double *last_rate) {
  double middle_rate[MODEL_NODES], late_rate[MODEL_NODES], error_ratio = 0.0;
  int node;
  for (node = 0; node < MODEL_NODES; ++node) {
    to_C[node] = from_C[node] + 0.5 * step_s * first_rate[node];
  }
  motor_rates(value, to_C, middle_rate);
  for (node = 0; node < MODEL_NODES; ++node) {
    to_C[node] = from_C[node] + 0.75 * step_s * middle_rate[node];
  }
  motor_rates(value, to_C, late_rate);
  for (node = 0; node < MODEL_NODES; ++node) {
    to_C[node] = from_C[node] + step_s * (2.0 * first_rate[node] + 3.0 * middle_rate[node] + 4.0 * late_rate[node]) / 9.0;
  }
  motor_rates(value, to_C, last_rate);
  for (node = 0; node < MODEL_NODES; ++node) {
    const double error_K =
        step_s * (-5.0 / 72.0 * first_rate[node] + middle_rate[node] / 12.0 + late_rate[node] / 9.0 - last_rate[node] / 8.0);
    const double ratio = fabs(error_K) / TOLERANCE_K;
    if (!(ratio <= error_ratio)) {
      error_ratio = isfinite(ratio) ? ratio : HUGE_VAL;
    }
  }
  return error_ratio;
}

/* Bisection over shorter attempts from the same start: the shortest step after which a limit was crossed, and its end. */
static double crossing_after_s(const double *value, double step_s, const double *from_C, const double *first_rate, double *to_C,
                               double *last_rate) {
  const int was_over = is_over(from_C);
  double before_s = 0.0;
  double after_s = step_s;
  while (after_s - before_s > LOCATED_S) {
    const double middle_s = 0.5 * (before_s + after_s);
    attempt(value, middle_s, from_C, first_rate, to_C, last_rate);
    if (is_over(to_C) == was_over) {
      before_s = middle_s;
    } else {
      after_s = middle_s;
    }
  }
  attempt(value, after_s, from_C, first_rate, to_C, last_rate);
  return after_s;
}

const char *model_step(model_state *state, double until_s, model_events events, int *is_event) {
  const double begin_s = state->value[at_time_s];
  double duration_s = until_s - begin_s;
  double *const now_C = state->value + MODEL_FIRST_NODE;
  double rate[MODEL_NODES], next_C[MODEL_NODES], next_rate[MODEL_NODES], done_s = 0.0;
  double step_s = state->part.step_s > 0.0 ? state->part.step_s : duration_s;
  long steps;
  motor_rates(state->value, now_C, rate);
  for (steps = 0; done_s < duration_s; ++steps) {
    const double left_s = duration_s - done_s;
    const double tried_s = step_s < left_s ? step_s : left_s;
    const double error_ratio = attempt(state->value, tried_s, now_C, rate, next_C, next_rate);
    const double factor = error_ratio > 0.0 ? 0.9 / cbrt(error_ratio) : 5.0;
    if (steps > MOST_STEPS || !(step_s > 1e-12 * duration_s)) {
      return "the temperatures change too fast for the integration; check the units of the inputs";
    }
    if (error_ratio <= 1.0) {
      int node;
      if (is_over(next_C) != is_over(now_C)) {
        double crossing_C[MODEL_NODES], crossing_rate[MODEL_NODES];
        const double after_s = crossing_after_s(state->value, tried_s, now_C, rate, crossing_C, crossing_rate);
        state->part.crossing_s = begin_s + done_s + after_s;
        if (events == events_end_step && after_s < left_s) {
          memcpy(next_C, crossing_C, sizeof next_C);
          memcpy(next_rate, crossing_rate, sizeof next_rate);
          duration_s = done_s + after_s;
          until_s = begin_s + duration_s;
        }
      }
      for (node = 0; node < MODEL_NODES; ++node) {
        now_C[node] = next_C[node];
        rate[node] = next_rate[node];
      }
      done_s = tried_s < left_s ? done_s + tried_s : duration_s;
      if (now_C[0] > state->value[at_winding_peak_C]) {
        state->value[at_winding_peak_C] = now_C[0];
      }
    }
    /* a step shortened only by the end does not set the size of the next */
    if (error_ratio > 1.0 || tried_s >= step_s || factor * tried_s > step_s) {
      step_s = tried_s * (factor > 5.0 ? 5.0 : factor > 0.2 ? factor : 0.2);
    }
  }
  state->part.step_s = step_s;
  state->value[at_time_s] = until_s;
  if (events != events_inside && is_over(now_C) != (state->value[at_over_limit] > 0.5)) {
    *is_event = 1;
  }
  return outputs(state, events);
}
