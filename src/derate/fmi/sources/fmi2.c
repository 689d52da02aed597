/* FMI 2.0 co-simulation over instance.h. */
#include "fmi2.h"

#include <stdlib.h>
#include <string.h>

#include "instance.h"

typedef struct {
  instance_state state;
  fmi2CallbackFunctions callbacks;
  char *name;
} component;

static fmi2Status refuse(const component *of, const char *problem) {
  if (!problem) {
    return fmi2OK;
  }
  if (of->callbacks.logger) {
    of->callbacks.logger(of->callbacks.componentEnvironment, of->name, fmi2Error, "logStatusError", "%s", problem);
  }
  return fmi2Error;
}

static fmi2Status not_there(fmi2Component of, const char *what) { return refuse((const component *)of, what); }

FMI2_Export const char *fmi2GetTypesPlatform(void) { return "default"; }
FMI2_Export const char *fmi2GetVersion(void) { return "2.0"; }

FMI2_Export fmi2Status fmi2SetDebugLogging(fmi2Component of, fmi2Boolean is_on, size_t count, const fmi2String categories[]) {
  (void)of;
  (void)is_on;
  (void)count;
  (void)categories;
  return fmi2OK; /* errors are always logged, and there is nothing else */
}

FMI2_Export fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                          const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean is_logging) {
  component *const made = calloc(1, sizeof *made);
  (void)resources;
  (void)visible;
  (void)is_logging;
  if (!made) {
    return 0;
  }
  if (callbacks) {
    made->callbacks = *callbacks;
  }
  made->name = malloc(name ? strlen(name) + 1 : 1);
  if (made->name) {
    strcpy(made->name, name ? name : "");
  }
  instance_make(&made->state, events_inside);
  if (!made->name || type != fmi2CoSimulation || !guid || strcmp(guid, MODEL_TOKEN) != 0) {
    if (made->name) {
      refuse(made, type != fmi2CoSimulation ? "this FMU is for co-simulation" : "the guid is not the one of this FMU");
    }
    free(made->name);
    free(made);
    return 0;
  }
  return made;
}

FMI2_Export void fmi2FreeInstance(fmi2Component of) {
  if (of) {
    free(((component *)of)->name);
    free(of);
  }
}

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component of, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start_s,
                                           fmi2Boolean has_stop, fmi2Real stop_s) {
  component *const me = of;
  (void)has_tolerance;
  (void)tolerance;
  (void)has_stop;
  (void)stop_s;
  if (me->state.mode != mode_made) {
    return refuse(me, "the experiment is set up once, before initialization mode");
  }
  me->state.model.value[at_time_s] = start_s;
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component of) {
  component *const me = of;
  return refuse(me, instance_begin(&me->state, me->state.model.value[at_time_s]));
}

FMI2_Export fmi2Status fmi2ExitInitializationMode(fmi2Component of) {
  component *const me = of;
  return refuse(me, instance_end_initialization(&me->state));
}

FMI2_Export fmi2Status fmi2Terminate(fmi2Component of) {
  component *const me = of;
  return refuse(me, instance_terminate(&me->state));
}

FMI2_Export fmi2Status fmi2Reset(fmi2Component of) {
  instance_reset(&((component *)of)->state);
  return fmi2OK;
}

#define VALUES(Type, get, set, type)                                                                                       \
  FMI2_Export fmi2Status get(fmi2Component of, const fmi2ValueReference references[], size_t count, Type values[]) {       \
    component *const me = of;                                                                                              \
    size_t i;                                                                                                              \
    for (i = 0; i < count; ++i) {                                                                                          \
      double value = 0.0;                                                                                                  \
      const char *const problem = instance_get(&me->state, references[i], type, &value);                                   \
      if (problem) {                                                                                                       \
        return refuse(me, problem);                                                                                        \
      }                                                                                                                    \
      values[i] = (Type)value;                                                                                             \
    }                                                                                                                      \
    return fmi2OK;                                                                                                         \
  }                                                                                                                        \
  FMI2_Export fmi2Status set(fmi2Component of, const fmi2ValueReference references[], size_t count, const Type values[]) { \
    component *const me = of;                                                                                              \
    size_t i;                                                                                                              \
    for (i = 0; i < count; ++i) {                                                                                          \
      const char *const problem = instance_set(&me->state, references[i], type, (double)values[i]);                        \
      if (problem) {                                                                                                       \
        return refuse(me, problem);                                                                                        \
      }                                                                                                                    \
    }                                                                                                                      \
    return fmi2OK;                                                                                                         \
  }

VALUES(fmi2Real, fmi2GetReal, fmi2SetReal, type_real)
VALUES(fmi2Integer, fmi2GetInteger, fmi2SetInteger, type_enumeration)
VALUES(fmi2Boolean, fmi2GetBoolean, fmi2SetBoolean, type_boolean)

FMI2_Export fmi2Status fmi2GetString(fmi2Component of, const fmi2ValueReference references[], size_t count, fmi2String values[]) {
  (void)references;
  (void)values;
  return count == 0 ? fmi2OK : not_there(of, "this FMU has no string variables");
}

FMI2_Export fmi2Status fmi2SetString(fmi2Component of, const fmi2ValueReference references[], size_t count, const fmi2String values[]) {
  (void)references;
  (void)values;
  return count == 0 ? fmi2OK : not_there(of, "this FMU has no string variables");
}

FMI2_Export fmi2Status fmi2GetFMUstate(fmi2Component of, fmi2FMUstate *kept) {
  component *const me = of;
  return refuse(me, instance_keep(&me->state, kept));
}

FMI2_Export fmi2Status fmi2SetFMUstate(fmi2Component of, fmi2FMUstate kept) {
  component *const me = of;
  return refuse(me, instance_restore(&me->state, kept, sizeof me->state));
}

FMI2_Export fmi2Status fmi2FreeFMUstate(fmi2Component of, fmi2FMUstate *kept) {
  (void)of;
  free(*kept);
  *kept = 0;
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2SerializedFMUstateSize(fmi2Component of, fmi2FMUstate kept, size_t *size) {
  (void)of;
  (void)kept;
  *size = sizeof(instance_state);
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2SerializeFMUstate(fmi2Component of, fmi2FMUstate kept, fmi2Byte bytes[], size_t size) {
  return refuse(of, instance_serialize(kept, bytes, size));
}

FMI2_Export fmi2Status fmi2DeSerializeFMUstate(fmi2Component of, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept) {
  component *const me = of;
  return refuse(me, instance_deserialize(&me->state, bytes, size, kept));
}

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component of, const fmi2ValueReference unknowns[], size_t unknown_count,
                                                    const fmi2ValueReference knowns[], size_t known_count, const fmi2Real seed[],
                                                    fmi2Real sensitivity[]) {
  (void)unknowns;
  (void)unknown_count;
  (void)knowns;
  (void)known_count;
  (void)seed;
  (void)sensitivity;
  return not_there(of, "this FMU gives no derivatives");
}

FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component of, const fmi2ValueReference references[], size_t count,
                                                   const fmi2Integer orders[], const fmi2Real values[]) {
  (void)references;
  (void)count;
  (void)orders;
  (void)values;
  return not_there(of, "inputs are held over a step: this FMU takes no derivatives of them");
}

FMI2_Export fmi2Status fmi2GetRealOutputDerivatives(fmi2Component of, const fmi2ValueReference references[], size_t count,
                                                    const fmi2Integer orders[], fmi2Real values[]) {
  (void)references;
  (void)count;
  (void)orders;
  (void)values;
  return not_there(of, "this FMU gives no derivatives");
}

FMI2_Export fmi2Status fmi2DoStep(fmi2Component of, fmi2Real current_s, fmi2Real step_s, fmi2Boolean is_final) {
  component *const me = of;
  int is_event = 0; /* FMI 2.0 has no event mode for co-simulation */
  (void)is_final;
  return refuse(me, instance_step(&me->state, current_s, step_s, &is_event));
}

FMI2_Export fmi2Status fmi2CancelStep(fmi2Component of) {
  return not_there(of, "a step is complete when fmi2DoStep returns: there is nothing to cancel");
}

FMI2_Export fmi2Status fmi2GetStatus(fmi2Component of, const fmi2StatusKind kind, fmi2Status *value) {
  (void)kind;
  *value = ((component *)of)->state.mode == mode_failed ? fmi2Error : fmi2OK;
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component of, const fmi2StatusKind kind, fmi2Real *value) {
  if (kind != fmi2LastSuccessfulTime) {
    return not_there(of, "there is no such status");
  }
  *value = ((component *)of)->state.model.value[at_time_s];
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetIntegerStatus(fmi2Component of, const fmi2StatusKind kind, fmi2Integer *value) {
  (void)kind;
  (void)value;
  return not_there(of, "there is no such status");
}

FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component of, const fmi2StatusKind kind, fmi2Boolean *value) {
  if (kind != fmi2Terminated) {
    return not_there(of, "there is no such status");
  }
  *value = ((component *)of)->state.mode == mode_terminated;
  return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetStringStatus(fmi2Component of, const fmi2StatusKind kind, fmi2String *value) {
  (void)kind;
  *value = "";
  return not_there(of, "there is no such status");
}
