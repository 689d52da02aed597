#include <fmt/format.h>

#include <cmath>

#include "base/diagnostic.h"
#include "derate/export_text.h"
#include "derate/fmi/fmu.h"
#include "derate/rate_lines.h"

namespace heatsoak::derate {
namespace {

const LineStyle kStyle{
    .literal = fmu_number,
    .signal =
        [](observed::Signal signal) { return fmt::format("value[at_{}]", observed::signals()[static_cast<std::size_t>(signal)].name); },
    .square_root = "sqrt",
    .number = "double",
    .exponential = "exp",
    .power = "positive_power"};

/// limit_crossing_s before the first crossing.
constexpr double kNoCrossing_s = -1.0;

void require_expressible(const Derating& derating, std::string_view exporter) {
  for (const ActingEffect& effect : derating.effects) {
    if (!effect.column.empty()) {
      throw base::Failure(
          base::ExitCode::bad_input,
          fmt::format("{} cannot express {} ({}): it depends on {} of the logs, which a simulation does not have; state the "
                      "condition with --condition, or use --to c_header, which uses its hottest value",
                      exporter, effect.name, effect.type, effect.column));
    }
  }
}

std::vector<FmuVariable> motor_variables(const Derating& derating) {
  constexpr double kRoom_C = 25.0;
  std::vector<FmuVariable> all{{"time_s", FmuCausality::independent, FmuType::real, 0.0, "simulated time"}};
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<observed::Signal>(i))) {
      const observed::SignalSpec& signal = observed::signals()[i];
      const std::string name(signal.name);
      all.push_back(
          {name, FmuCausality::input, FmuType::real, name.ends_with("_C") ? kRoom_C : 0.0,
           i == observed::current
               ? "equivalent DC current (torque per torque constant), rms over the step, with the sign of the speed when the motor drives"
           : i == observed::ambient ? "air around the motor"
                                    : std::string(signal.meaning)});
    }
  }
  for (const std::string& node : derating.observer.state_names()) {
    all.push_back({identifier(node) + "_start_C", FmuCausality::parameter, FmuType::real, kRoom_C, "temperature at the start"});
  }
  for (const std::string& node : derating.observer.state_names()) {
    all.push_back({identifier(node) + "_C", FmuCausality::output, FmuType::real, 0.0, fmt::format("temperature of {}", node)});
  }
  all.push_back({"winding_peak_C", FmuCausality::output, FmuType::real, 0.0,
                 "highest winding temperature since the start, also inside a step"});
  all.push_back({"over_limit", FmuCausality::output, FmuType::boolean, 0.0, "whether winding or stator is above its limit"});
  all.push_back({"limit_crossing_s", FmuCausality::output, FmuType::real, 0.0,
                 fmt::format("when over_limit last changed, located within the step; {:.0f} s before the first time", kNoCrossing_s),
                 true});
  all.push_back(
      {"winding_limit_C", FmuCausality::constant, FmuType::real, derating.rules.limits.winding_C, "limit of the winding"});
  if (derating.rules.limits.stator_C) {
    all.push_back(
        {"stator_limit_C", FmuCausality::constant, FmuType::real, *derating.rules.limits.stator_C, "limit of the stator"});
  }
  return all;
}

std::string rates_text(const Derating& derating) {
  const RateLines lines(derating.observer, derating.observer.nominal_rate_steps(), kStyle);
  std::string text =
      "/* dT/dt of every node: the laws of the motor's network as straight-line code. */\n#include <math.h>\n\n#include \"model.h\"\n\n";
  if (lines.text().find(kStyle.power) != std::string::npos) {
    text += "static double positive_power(double base, double exponent) { return base > 0.0 ? pow(base, exponent) : 0.0; }\n\n";
  }
  for (const ActingEffect& effect : derating.effects) {
    std::string law = fmt::format("{}: {}", effect.name, effect.equation);
    for (std::size_t at = law.find("*/"); at != std::string::npos; at = law.find("*/")) {
      law.replace(at, 2, "* /");
    }
    text += fmt::format("/* {} */\n", law);
  }
  return text +
         "void motor_rates(const double *value, const double *state_C, double *rate_K_per_s);\n\n"
         "void motor_rates(const double *value, const double *state_C, double *rate_K_per_s) {\n" +
         lines.text() + "}\n";
}

}  // namespace

FmuModel motor_fmu(const Derating& derating, std::string_view exporter) {
  require_finite(derating);
  require_expressible(derating, exporter);
  FmuModel model;
  model.identifier = identifier(derating.motor_id) + "_motor";
  model.description =
      fmt::format("Thermal network of {} in {}, nominal values: {}", derating.motor_id, derating.robot_id, own_effects_text(derating));
  model.token = fmt::format("{}-motor-{}", derating.provenance.input_hash, derating.provenance.program_version);
  model.provenance = provenance_lines(derating, "");
  model.variables = motor_variables(derating);
  const std::string first = identifier(derating.observer.state_names().front());
  model.sources = fmu_tables(
      model,
      fmt::format("#define MODEL_TAKES_UNKNOWN 0\n#define MODEL_NODES {}\n#define MODEL_FIRST_START at_{}_start_C\n"
                  "#define MODEL_FIRST_NODE at_{}_C\n#define MODEL_WINDING_LIMIT_C {}\n#define MODEL_STATOR_LIMIT_C {} /* 0: none */\n"
                  "#define MODEL_NO_CROSSING_S {}\n\ntypedef struct {{\n  double step_s;     /* step that the last error allows; 0 at the "
                  "start */\n"
                  "  double crossing_s; /* when over_limit last changed */\n}} model_part;\n",
                  derating.observer.state_count(), first, first, fmu_number(derating.rules.limits.winding_C),
                  fmu_number(derating.rules.limits.stator_C.value_or(0.0)), fmu_number(kNoCrossing_s)));
  model.sources.push_back({"rates.c", rates_text(derating)});
  return model;
}

}  // namespace heatsoak::derate
