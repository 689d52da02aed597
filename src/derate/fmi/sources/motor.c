/* A motor's thermal network with its effects, in double precision. Method: Bogacki and Shampine 1989, third order with an embedded second
   order for the step. */
#include <math.h>

#include "model.h"

/* K per step; the model is compared to a tenth of a kelvin */
#define TOLERANCE_K 1e-4
#define MOST_STEPS 10000000L

/* dT/dt of every node, from inputs and temperatures (model_data.c). */
void motor_rates(const double *value, const double *state_C, double *rate_K_per_s);

static const char *outputs(model_state *state) {
  int node;
  for (node = 0; node < MODEL_NODES; ++node) {
    if (!isfinite(state->value[MODEL_FIRST_NODE + node])) {
      return "a temperature is not finite: the motor is far above its limit, or an input is not finite";
    }
  }
  if (state->value[MODEL_FIRST_NODE] > state->value[at_winding_peak_C]) {
    state->value[at_winding_peak_C] = state->value[MODEL_FIRST_NODE];
  }
  state->value[at_over_limit] = state->value[MODEL_FIRST_NODE] > MODEL_WINDING_LIMIT_C ||
                                        (MODEL_STATOR_LIMIT_C > 0.0 && state->value[MODEL_FIRST_NODE + 1] > MODEL_STATOR_LIMIT_C)
                                    ? 1.0
                                    : 0.0;
  return 0;
}

const char *model_begin(model_state *state) {
  int node;
  for (node = 0; node < MODEL_NODES; ++node) {
    state->value[MODEL_FIRST_NODE + node] = state->value[MODEL_FIRST_START + node];
  }
  state->value[at_winding_peak_C] = state->value[MODEL_FIRST_NODE];
  state->part.step_s = 0.0;
  return outputs(state);
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

const char *model_step(model_state *state, double until_s) {
  const double duration_s = until_s - state->value[at_time_s];
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
  return outputs(state);
}
