/* FMI 3.0 co-simulation over instance.h. */
#include "fmi3.h"

#include <stdlib.h>
#include <string.h>

#include "fmi3_component.h"
#include "instance.h"

typedef struct {
  instance_state state;
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
} component;

fmi3Status fmi3_refuse(fmi3Instance of, const char *problem) {
  const component *const me = of;
  if (!problem) {
    return fmi3OK;
  }
  if (me->log) {
    me->log(me->environment, fmi3Error, "logStatusError", problem);
  }
  return fmi3Error;
}

FMI3_Export const char *fmi3GetVersion(void) { return "3.0"; }

FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance of, fmi3Boolean is_on, size_t count, const fmi3String categories[]) {
  (void)of;
  (void)is_on;
  (void)count;
  (void)categories;
  return fmi3OK; /* errors are always logged, and there is nothing else */
}

FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                                     fmi3Boolean is_logging, fmi3Boolean has_event_mode, fmi3Boolean may_return_early,
                                                     const fmi3ValueReference required[], size_t required_count,
                                                     fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                                     fmi3IntermediateUpdateCallback intermediate) {
  component *const made = calloc(1, sizeof *made);
  (void)name;
  (void)resources;
  (void)visible;
  (void)is_logging;
  (void)required;
  (void)intermediate;
  if (!made) {
    return 0;
  }
  made->environment = environment;
  made->log = log;
  instance_make(&made->state, !has_event_mode ? events_inside : may_return_early ? events_end_step : events_after_step);
  if (!token || strcmp(token, MODEL_TOKEN) != 0 || required_count > 0) {
    fmi3_refuse(made, required_count > 0 ? "this FMU gives no intermediate values" : "the instantiation token is not the one of this FMU");
    free(made);
    return 0;
  }
  return made;
}

FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                                      fmi3Boolean is_logging, fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log) {
  (void)name;
  (void)token;
  (void)resources;
  (void)visible;
  (void)is_logging;
  (void)environment;
  (void)log;
  return 0; /* this FMU is for co-simulation */
}

FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                                           fmi3Boolean is_logging, fmi3InstanceEnvironment environment,
                                                           fmi3LogMessageCallback log, fmi3ClockUpdateCallback clock_update,
                                                           fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
  (void)name;
  (void)token;
  (void)resources;
  (void)visible;
  (void)is_logging;
  (void)environment;
  (void)log;
  (void)clock_update;
  (void)lock;
  (void)unlock;
  return 0; /* this FMU is for co-simulation */
}

FMI3_Export void fmi3FreeInstance(fmi3Instance of) { free(of); }

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance of, fmi3Boolean has_tolerance, fmi3Float64 tolerance, fmi3Float64 start_s,
                                                   fmi3Boolean has_stop, fmi3Float64 stop_s) {
  component *const me = of;
  (void)has_tolerance;
  (void)tolerance;
  (void)has_stop;
  (void)stop_s;
  return fmi3_refuse(of, instance_begin(&me->state, start_s));
}

FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance of) {
  component *const me = of;
  return fmi3_refuse(of, instance_end_initialization(&me->state));
}

FMI3_Export fmi3Status fmi3Terminate(fmi3Instance of) {
  component *const me = of;
  return fmi3_refuse(of, instance_terminate(&me->state));
}

FMI3_Export fmi3Status fmi3Reset(fmi3Instance of) {
  component *const me = of;
  instance_reset(&me->state);
  return fmi3OK;
}

#define VALUES(Type, get, set, type)                                                                                                    \
  FMI3_Export fmi3Status get(fmi3Instance of, const fmi3ValueReference references[], size_t count, Type values[], size_t value_count) { \
    component *const me = of;                                                                                                           \
    size_t i;                                                                                                                           \
    for (i = 0; i < count && i < value_count; ++i) {                                                                                    \
      double value = 0.0;                                                                                                               \
      const char *const problem = instance_get(&me->state, references[i], type, &value);                                                \
      if (problem) {                                                                                                                    \
        return fmi3_refuse(of, problem);                                                                                                \
      }                                                                                                                                 \
      values[i] = (Type)value;                                                                                                          \
    }                                                                                                                                   \
    return fmi3_refuse(of, count == value_count ? 0 : "expected as many values as references, because no variable is an array");        \
  }                                                                                                                                     \
  FMI3_Export fmi3Status set(fmi3Instance of, const fmi3ValueReference references[], size_t count, const Type values[],                 \
                             size_t value_count) {                                                                                      \
    component *const me = of;                                                                                                           \
    size_t i;                                                                                                                           \
    for (i = 0; i < count && i < value_count; ++i) {                                                                                    \
      const char *const problem = instance_set(&me->state, references[i], type, (double)values[i]);                                     \
      if (problem) {                                                                                                                    \
        return fmi3_refuse(of, problem);                                                                                                \
      }                                                                                                                                 \
    }                                                                                                                                   \
    return fmi3_refuse(of, count == value_count ? 0 : "expected as many values as references, because no variable is an array");        \
  }

VALUES(fmi3Float64, fmi3GetFloat64, fmi3SetFloat64, type_real)
VALUES(fmi3Int64, fmi3GetInt64, fmi3SetInt64, type_enumeration)
VALUES(fmi3Boolean, fmi3GetBoolean, fmi3SetBoolean, type_boolean)

FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance of, fmi3FMUState *kept) {
  component *const me = of;
  return fmi3_refuse(of, instance_keep(&me->state, kept));
}

FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance of, fmi3FMUState kept) {
  component *const me = of;
  return fmi3_refuse(of, instance_restore(&me->state, kept, sizeof me->state));
}

FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance of, fmi3FMUState *kept) {
  (void)of;
  free(*kept);
  *kept = 0;
  return fmi3OK;
}

FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance of, fmi3FMUState kept, size_t *size) {
  (void)of;
  (void)kept;
  *size = sizeof(instance_state);
  return fmi3OK;
}

FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance of, fmi3FMUState kept, fmi3Byte bytes[], size_t size) {
  return fmi3_refuse(of, instance_serialize(kept, bytes, size));
}

FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance of, const fmi3Byte bytes[], size_t size, fmi3FMUState *kept) {
  component *const me = of;
  return fmi3_refuse(of, instance_deserialize(&me->state, bytes, size, kept));
}

FMI3_Export fmi3Status fmi3DoStep(fmi3Instance of, fmi3Float64 current_s, fmi3Float64 step_s, fmi3Boolean no_earlier_state,
                                  fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early_return, fmi3Float64 *last_s) {
  component *const me = of;
  int is_event = 0;
  const fmi3Status status = fmi3_refuse(of, instance_step(&me->state, current_s, step_s, &is_event));
  (void)no_earlier_state;
  *event_needed = is_event != 0;
  *terminate = fmi3False;
  *last_s = me->state.model.value[at_time_s];
  *early_return = status == fmi3OK && *last_s < current_s + step_s;
  return status;
}

FMI3_Export fmi3Status fmi3EnterEventMode(fmi3Instance of) {
  component *const me = of;
  return fmi3_refuse(of, instance_enter_events(&me->state));
}

FMI3_Export fmi3Status fmi3UpdateDiscreteStates(fmi3Instance of, fmi3Boolean *need_update, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals_changed, fmi3Boolean *values_changed, fmi3Boolean *has_next_event,
                                                fmi3Float64 *next_event_s) {
  component *const me = of;
  int has_next = 0;
  const fmi3Status status = fmi3_refuse(of, instance_end_event(&me->state, &has_next, next_event_s));
  *need_update = fmi3False;
  *terminate = fmi3False;
  *nominals_changed = fmi3False;
  *values_changed = fmi3False;
  *has_next_event = has_next != 0;
  return status;
}

FMI3_Export fmi3Status fmi3EnterStepMode(fmi3Instance of) {
  component *const me = of;
  return fmi3_refuse(of, instance_enter_steps(&me->state));
}
