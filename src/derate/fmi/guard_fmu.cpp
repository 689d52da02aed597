#include <fmt/format.h>

#include <algorithm>

#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate {
namespace {

/// Reasons of the C header, in its order.
constexpr FmuItem kReasons[] = {{"full", "all that a cold motor may draw at this speed, or the driver's largest current"},
                                {"derated", "less, because the winding or the stator is hot"},
                                {"no_current", "at the limit, or above the highest speed of the table"},
                                {"input_unknown", "an input was NaN or implausible: its hottest case was used"},
                                {"not_started", "the state was not started or damaged: taken as hot as the limit"}};

/// Value of an input that the user does not connect: the worst case for which the guard is designed, and the hours of a new motor.
double start_value(const Derating& derating, const observed::SignalSpec& signal) {
  switch (signal.without_power) {
    case thermal::WithoutPower::hottest_air:
      return derating.rules.hottest_ambient_C;
    case thermal::WithoutPower::winding_limit:
      return derating.rules.limits.winding_C;
    case thermal::WithoutPower::unstated:
    case thermal::WithoutPower::zero:
    case thermal::WithoutPower::any:
      break;
  }
  return 0.0;
}

std::vector<FmuVariable> guard_variables(const Derating& derating) {
  std::vector<FmuVariable> all{{"time_s", FmuCausality::independent, FmuType::real, 0.0, "simulated time"}};
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<observed::Signal>(i))) {
      const observed::SignalSpec& signal = observed::signals()[i];
      all.push_back(
          {std::string(signal.name), FmuCausality::input, FmuType::real, start_value(derating, signal), std::string(signal.meaning)});
    }
  }
  all.push_back({"start_C", FmuCausality::parameter, FmuType::real, derating.rules.hottest_ambient_C,
                 "temperature of the whole motor at the start; after a long rest that of the board"});
  const auto output = [&all](std::string name, FmuType type, std::string description) {
    all.push_back({std::move(name), FmuCausality::output, type, 0.0, std::move(description), true});
  };
  output("allowed_current_A", FmuType::real, "equivalent DC current, magnitude, until the next call");
  output("guarded_winding_C", FmuType::real, "pessimistic; sets the allowed current");
  output("nominal_winding_C", FmuType::real, "motor with nominal values; for display only");
  output("reason", FmuType::enumeration, "reason for the allowed current");
  output("is_limiting", FmuType::boolean, "whether the guard allows less than to a cold motor, and less than the driver's largest current");
  all.push_back({"limp_current_A", FmuCausality::constant, FmuType::real, limp_current_A(derating),
                 "continuous current at every speed, for a wheel of unknown speed"});
  return all;
}

std::string bindings(const Derating& derating) {
  const std::string prefix = identifier(derating.motor_id);
  std::string text = fmt::format(
      "#include \"motor_guard.h\"\n\n#define MODEL_TAKES_UNKNOWN 1 /* an input that is not a number is replaced by its worst case */\n"
      "#define GUARD_PERIOD_S {1}\n#define guard_full {0}_full\n#define guard_start {0}_start\n#define guard_step "
      "{0}_step\n\n"
      "typedef {0}_state guard_state;\ntypedef {0}_input guard_input;\ntypedef {0}_output guard_output;\n\n"
      "typedef struct {{\n  guard_state guard;\n  double calls;\n  double start_s;\n}} model_part;\n\n"
      "static inline void guard_read(const double *value, guard_input *input) {{\n",
      prefix, fmu_number(derating.options.period_s));
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<observed::Signal>(i))) {
      text += fmt::format("  input->{0} = (float)value[at_{0}];\n", observed::signals()[i].name);
    }
  }
  return text + "}\n";
}

}  // namespace

FmuModel guard_fmu(const Derating& derating, std::string_view /*exporter*/) {
  require_finite(derating);
  FmuModel model;
  model.identifier = identifier(derating.motor_id) + "_guard";
  model.description = fmt::format("Thermal guard of the firmware for {} in {}", derating.motor_id, derating.robot_id);
  model.token = fmt::format("{}-guard-{}", derating.provenance.input_hash, derating.provenance.program_version);
  model.provenance = provenance_lines(derating, "");
  model.variables = guard_variables(derating);
  model.items.assign(std::begin(kReasons), std::end(kReasons));
  model.step_s = derating.options.period_s;
  model.fixed_step_s = derating.options.period_s;
  model.sources = fmu_tables(model, bindings(derating));
  const std::vector<ExporterType>& exporters = all_exporters();
  model.sources.push_back({"motor_guard.h", std::ranges::find(exporters, "c_header", &ExporterType::name)->write(derating)});
  return model;
}

}  // namespace heatsoak::derate
