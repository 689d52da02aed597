/* Functions of FMI 3.0 that this FMU does not support; its binary must still define them. */
#include "fmi3.h"
#include "fmi3_component.h"

static fmi3Status none_of(fmi3Instance of, size_t count) { return fmi3_refuse(of, count == 0 ? 0 : "there are no variables of this type"); }

#define NO_VALUES(Type, get, set)                                                                                                       \
  FMI3_Export fmi3Status get(fmi3Instance of, const fmi3ValueReference references[], size_t count, Type values[], size_t value_count) { \
    (void)references;                                                                                                                   \
    (void)values;                                                                                                                       \
    (void)value_count;                                                                                                                  \
    return none_of(of, count);                                                                                                          \
  }                                                                                                                                     \
  FMI3_Export fmi3Status set(fmi3Instance of, const fmi3ValueReference references[], size_t count, const Type values[],                 \
                             size_t value_count) {                                                                                      \
    (void)references;                                                                                                                   \
    (void)values;                                                                                                                       \
    (void)value_count;                                                                                                                  \
    return none_of(of, count);                                                                                                          \
  }

NO_VALUES(fmi3Float32, fmi3GetFloat32, fmi3SetFloat32)
NO_VALUES(fmi3Int8, fmi3GetInt8, fmi3SetInt8)
NO_VALUES(fmi3UInt8, fmi3GetUInt8, fmi3SetUInt8)
NO_VALUES(fmi3Int16, fmi3GetInt16, fmi3SetInt16)
NO_VALUES(fmi3UInt16, fmi3GetUInt16, fmi3SetUInt16)
NO_VALUES(fmi3Int32, fmi3GetInt32, fmi3SetInt32)
NO_VALUES(fmi3UInt32, fmi3GetUInt32, fmi3SetUInt32)
NO_VALUES(fmi3UInt64, fmi3GetUInt64, fmi3SetUInt64)
NO_VALUES(fmi3String, fmi3GetString, fmi3SetString)

FMI3_Export fmi3Status fmi3GetBinary(fmi3Instance of, const fmi3ValueReference references[], size_t count, size_t sizes[],
                                     fmi3Binary values[], size_t value_count) {
  (void)references;
  (void)sizes;
  (void)values;
  (void)value_count;
  return none_of(of, count);
}

FMI3_Export fmi3Status fmi3SetBinary(fmi3Instance of, const fmi3ValueReference references[], size_t count, const size_t sizes[],
                                     const fmi3Binary values[], size_t value_count) {
  (void)references;
  (void)sizes;
  (void)values;
  (void)value_count;
  return none_of(of, count);
}

FMI3_Export fmi3Status fmi3GetClock(fmi3Instance of, const fmi3ValueReference references[], size_t count, fmi3Clock values[]) {
  (void)references;
  (void)values;
  return none_of(of, count);
}

FMI3_Export fmi3Status fmi3SetClock(fmi3Instance of, const fmi3ValueReference references[], size_t count, const fmi3Clock values[]) {
  (void)references;
  (void)values;
  return none_of(of, count);
}

FMI3_Export fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance of, fmi3ValueReference reference, size_t *count) {
  (void)reference;
  (void)count;
  return fmi3_refuse(of, "this FMU gives no derivatives and no dependencies");
}

FMI3_Export fmi3Status fmi3GetVariableDependencies(fmi3Instance of, fmi3ValueReference reference, size_t elements[],
                                                   fmi3ValueReference independents[], size_t independent_elements[],
                                                   fmi3DependencyKind kinds[], size_t count) {
  (void)reference;
  (void)elements;
  (void)independents;
  (void)independent_elements;
  (void)kinds;
  (void)count;
  return fmi3_refuse(of, "this FMU gives no derivatives and no dependencies");
}

FMI3_Export fmi3Status fmi3GetDirectionalDerivative(fmi3Instance of, const fmi3ValueReference unknowns[], size_t unknown_count,
                                                    const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],
                                                    size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count) {
  (void)unknowns;
  (void)unknown_count;
  (void)knowns;
  (void)known_count;
  (void)seed;
  (void)seed_count;
  (void)sensitivity;
  (void)sensitivity_count;
  return fmi3_refuse(of, "this FMU gives no derivatives and no dependencies");
}

FMI3_Export fmi3Status fmi3GetAdjointDerivative(fmi3Instance of, const fmi3ValueReference unknowns[], size_t unknown_count,
                                                const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],
                                                size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count) {
  (void)unknowns;
  (void)unknown_count;
  (void)knowns;
  (void)known_count;
  (void)seed;
  (void)seed_count;
  (void)sensitivity;
  (void)sensitivity_count;
  return fmi3_refuse(of, "this FMU gives no derivatives and no dependencies");
}

FMI3_Export fmi3Status fmi3GetOutputDerivatives(fmi3Instance of, const fmi3ValueReference references[], size_t count,
                                                const fmi3Int32 orders[], fmi3Float64 values[], size_t value_count) {
  (void)references;
  (void)count;
  (void)orders;
  (void)values;
  (void)value_count;
  return fmi3_refuse(of, "this FMU gives no derivatives and no dependencies");
}

FMI3_Export fmi3Status fmi3EnterConfigurationMode(fmi3Instance of) {
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3ExitConfigurationMode(fmi3Instance of) { return fmi3_refuse(of, "this FMU has no clocks and no configuration"); }

FMI3_Export fmi3Status fmi3GetIntervalDecimal(fmi3Instance of, const fmi3ValueReference references[], size_t count, fmi3Float64 intervals[],
                                              fmi3IntervalQualifier qualifiers[]) {
  (void)references;
  (void)count;
  (void)intervals;
  (void)qualifiers;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3GetIntervalFraction(fmi3Instance of, const fmi3ValueReference references[], size_t count, fmi3UInt64 counters[],
                                               fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]) {
  (void)references;
  (void)count;
  (void)counters;
  (void)resolutions;
  (void)qualifiers;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3GetShiftDecimal(fmi3Instance of, const fmi3ValueReference references[], size_t count, fmi3Float64 shifts[]) {
  (void)references;
  (void)count;
  (void)shifts;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3GetShiftFraction(fmi3Instance of, const fmi3ValueReference references[], size_t count, fmi3UInt64 counters[],
                                            fmi3UInt64 resolutions[]) {
  (void)references;
  (void)count;
  (void)counters;
  (void)resolutions;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3SetIntervalDecimal(fmi3Instance of, const fmi3ValueReference references[], size_t count,
                                              const fmi3Float64 intervals[]) {
  (void)references;
  (void)count;
  (void)intervals;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3SetIntervalFraction(fmi3Instance of, const fmi3ValueReference references[], size_t count,
                                               const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
  (void)references;
  (void)count;
  (void)counters;
  (void)resolutions;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3SetShiftDecimal(fmi3Instance of, const fmi3ValueReference references[], size_t count,
                                           const fmi3Float64 shifts[]) {
  (void)references;
  (void)count;
  (void)shifts;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3SetShiftFraction(fmi3Instance of, const fmi3ValueReference references[], size_t count,
                                            const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
  (void)references;
  (void)count;
  (void)counters;
  (void)resolutions;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance of) {
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3ActivateModelPartition(fmi3Instance of, fmi3ValueReference clock, fmi3Float64 time_s) {
  (void)clock;
  (void)time_s;
  return fmi3_refuse(of, "this FMU has no clocks and no configuration");
}

FMI3_Export fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance of) { return fmi3_refuse(of, "this FMU is for co-simulation"); }

FMI3_Export fmi3Status fmi3CompletedIntegratorStep(fmi3Instance of, fmi3Boolean no_earlier_state, fmi3Boolean *enter_event_mode,
                                                   fmi3Boolean *terminate) {
  (void)no_earlier_state;
  (void)enter_event_mode;
  (void)terminate;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3SetTime(fmi3Instance of, fmi3Float64 time_s) {
  (void)time_s;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3SetContinuousStates(fmi3Instance of, const fmi3Float64 states[], size_t count) {
  (void)states;
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance of, fmi3Float64 derivatives[], size_t count) {
  (void)derivatives;
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetEventIndicators(fmi3Instance of, fmi3Float64 indicators[], size_t count) {
  (void)indicators;
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetContinuousStates(fmi3Instance of, fmi3Float64 states[], size_t count) {
  (void)states;
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance of, fmi3Float64 nominals[], size_t count) {
  (void)nominals;
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance of, size_t *count) {
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}

FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance of, size_t *count) {
  (void)count;
  return fmi3_refuse(of, "this FMU is for co-simulation");
}
