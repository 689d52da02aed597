#include "derate/fmi/description.h"

#include <fmt/format.h>

#include <initializer_list>
#include <map>
#include <utility>

#include "base/unit_names.h"
#include "base/version.h"
#include "base/xml_text.h"
#include "derate/export_text.h"

namespace heatsoak::derate {
namespace {

std::string number(double value) { return fmt::format("{}", rounded_to_12_digits(value)); }

/// Returns the attributes of the element BaseUnit, which are the same in FMI 2.0 and 3.0.
std::string base_unit(const base::SiUnit& unit) {
  std::string text;
  const std::initializer_list<std::pair<std::string_view, int>> exponents{{"kg", unit.kg}, {"m", unit.m}, {"rad", unit.rad},
                                                                          {"s", unit.s},   {"A", unit.A}, {"K", unit.K}};
  for (const auto& [name, exponent] : exponents) {
    text += exponent != 0 ? fmt::format(" {}=\"{}\"", name, exponent) : "";
  }
  text += unit.factor != 1.0 ? fmt::format(" factor=\"{}\"", number(unit.factor)) : "";
  return text + (unit.offset_K != 0.0 ? fmt::format(" offset=\"{}\"", number(unit.offset_K)) : "");
}

std::string units(const FmuModel& model) {
  std::map<std::string, base::SiUnit> used;
  for (const FmuVariable& each : model.variables) {
    if (const std::string unit = fmu_unit(each); !unit.empty()) {
      used[unit] = base::unit_of_name(each.name)->si;
    }
  }
  std::string text = "  <UnitDefinitions>\n";
  for (const auto& [name, si] : used) {
    text += fmt::format("    <Unit name=\"{}\"><BaseUnit{}/></Unit>\n", name, base_unit(si));
  }
  return text + "  </UnitDefinitions>\n";
}

std::string items(const FmuModel& model) {
  std::string text;
  for (std::size_t i = 0; i < model.items.size(); ++i) {
    text += fmt::format("        <Item name=\"{}\" value=\"{}\" description=\"{}\"/>\n", model.items[i].name, i,
                        base::xml_attribute(model.items[i].description));
  }
  return text;
}

struct Words {
  std::string_view causality;
  std::string_view variability;
  std::string_view initial;  ///< empty if the standard allows none
};
Words words(const FmuVariable& variable) {
  const bool is_discrete = variable.is_sampled || variable.type != FmuType::real;
  switch (variable.causality) {
    case FmuCausality::independent:
      return {"independent", "continuous", ""};
    case FmuCausality::input:
      return {"input", "continuous", ""};
    case FmuCausality::parameter:
      return {"parameter", "fixed", "exact"};
    case FmuCausality::constant:
      return {"local", "constant", "exact"};
    case FmuCausality::output:
      break;
  }
  return {"output", is_discrete ? "discrete" : "continuous", "calculated"};
}

bool has_start(const FmuVariable& variable) {
  return variable.causality != FmuCausality::output && variable.causality != FmuCausality::independent;
}

std::string attributes(const FmuVariable& variable, std::size_t reference) {
  const Words of = words(variable);
  return fmt::format("name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" variability=\"{}\"{}", variable.name, reference,
                     base::xml_attribute(variable.description), of.causality, of.variability,
                     of.initial.empty() ? "" : fmt::format(" initial=\"{}\"", of.initial));
}

std::string start_and_unit(const FmuVariable& variable) {
  const std::string unit = fmu_unit(variable);
  return (unit.empty() ? "" : fmt::format(" unit=\"{}\"", unit)) +
         (has_start(variable) ? fmt::format(" start=\"{}\"", number(variable.value)) : "");
}

std::string default_experiment(const FmuModel& model) {
  constexpr double kStop_s = 600.0;
  return fmt::format("  <DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{}\"/>\n", number(kStop_s), number(model.step_s));
}

std::string tool() { return fmt::format("heatsoak {}", base::program_version()); }

/// Calls visit(index) for every output variable.
template <class Visit>
void for_each_output(const FmuModel& model, const Visit& visit) {
  for (std::size_t i = 0; i < model.variables.size(); ++i) {
    if (model.variables[i].causality == FmuCausality::output) {
      visit(i);
    }
  }
}

constexpr std::string_view kLogCategories =
    "  <LogCategories>\n    <Category name=\"logStatusError\" description=\"errors in a call\"/>\n  </LogCategories>\n";

}  // namespace

std::string fmu_unit(const FmuVariable& variable) {
  const std::optional<base::UnitOfName> found =
      variable.type == FmuType::real ? base::unit_of_name(variable.name) : std::nullopt;
  std::string unit = found ? found->unit : "";
  std::erase(unit, '^');
  return unit;
}

std::string description_fmi2(const FmuModel& model, std::span<const std::string> compiled) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{0}\" guid=\"{1}\" description=\"{2}\" generationTool=\"{3}\" "
      "variableNamingConvention=\"flat\">\n"
      "  <CoSimulation modelIdentifier=\"{0}\" canHandleVariableCommunicationStepSize=\"true\" "
      "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\">\n    <SourceFiles>\n",
      model.identifier, base::xml_attribute(model.token), base::xml_attribute(model.description), base::xml_attribute(tool()));
  for (const std::string& name : compiled) {
    text += fmt::format("      <File name=\"{}\"/>\n", name);
  }
  text += "    </SourceFiles>\n  </CoSimulation>\n" + units(model);
  if (!model.items.empty()) {
    text += "  <TypeDefinitions>\n    <SimpleType name=\"reason_type\">\n      <Enumeration>\n" + items(model) +
            "      </Enumeration>\n    </SimpleType>\n  </TypeDefinitions>\n";
  }
  text += std::string(kLogCategories) + default_experiment(model) + "  <ModelVariables>\n";
  for (std::size_t i = 0; i < model.variables.size(); ++i) {
    const FmuVariable& each = model.variables[i];
    const std::string inner = each.type == FmuType::real      ? fmt::format("<Real{}/>", start_and_unit(each))
                              : each.type == FmuType::boolean ? std::string("<Boolean/>")
                                                              : std::string("<Enumeration declaredType=\"reason_type\"/>");
    text += fmt::format("    <ScalarVariable {}>{}</ScalarVariable>\n", attributes(each, i), inner);
  }
  text += "  </ModelVariables>\n  <ModelStructure>\n";
  for (const std::string_view list : {"Outputs", "InitialUnknowns"}) {
    text += fmt::format("    <{}>\n", list);
    for_each_output(model, [&](std::size_t place) { text += fmt::format("      <Unknown index=\"{}\"/>\n", place + 1); });
    text += fmt::format("    </{}>\n", list);
  }
  return text + "  </ModelStructure>\n</fmiModelDescription>\n";
}

std::string description_fmi3(const FmuModel& model) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{0}\" instantiationToken=\"{1}\" description=\"{2}\" generationTool=\"{3}\" "
      "variableNamingConvention=\"flat\">\n"
      "  <CoSimulation modelIdentifier=\"{0}\" canHandleVariableCommunicationStepSize=\"true\"{4} "
      "hasEventMode=\"true\" mightReturnEarlyFromDoStep=\"true\" canGetAndSetFMUState=\"true\" "
      "canSerializeFMUState=\"true\"/>\n",
      model.identifier, base::xml_attribute(model.token), base::xml_attribute(model.description), base::xml_attribute(tool()),
      model.fixed_step_s ? fmt::format(" fixedInternalStepSize=\"{}\"", number(*model.fixed_step_s)) : "");
  text += units(model);
  if (!model.items.empty()) {
    text += "  <TypeDefinitions>\n    <EnumerationType name=\"reason_type\">\n" + items(model) +
            "    </EnumerationType>\n  </TypeDefinitions>\n";
  }
  text += std::string(kLogCategories) + default_experiment(model) + "  <ModelVariables>\n";
  for (std::size_t i = 0; i < model.variables.size(); ++i) {
    const FmuVariable& each = model.variables[i];
    const std::string_view element = each.type == FmuType::real ? "Float64" : each.type == FmuType::boolean ? "Boolean" : "Enumeration";
    text += fmt::format("    <{} {}{}{}/>\n", element, attributes(each, i), start_and_unit(each),
                        each.type == FmuType::enumeration ? " declaredType=\"reason_type\"" : "");
  }
  text += "  </ModelVariables>\n  <ModelStructure>\n";
  for (const std::string_view list : {"Output", "InitialUnknown"}) {
    for_each_output(model, [&](std::size_t place) { text += fmt::format("    <{} valueReference=\"{}\"/>\n", list, place); });
  }
  return text + "  </ModelStructure>\n</fmiModelDescription>\n";
}

std::string build_description_fmi3(const FmuModel& model, std::span<const std::string> compiled) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n"
      "  <BuildConfiguration modelIdentifier=\"{}\" description=\"C99 and its mathematical library\">\n    <SourceFileSet "
      "language=\"C99\">\n",
      model.identifier);
  for (const std::string& name : compiled) {
    text += fmt::format("      <SourceFile name=\"{}\"/>\n", name);
  }
  return text +
         "    </SourceFileSet>\n    <Library name=\"m\" external=\"true\" description=\"of the C compiler\"/>\n  </BuildConfiguration>\n"
         "</fmiBuildDescription>\n";
}

}  // namespace heatsoak::derate
