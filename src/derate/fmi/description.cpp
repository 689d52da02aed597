#include "derate/fmi/description.h"

#include <fmt/format.h>

#include <array>
#include <set>

#include "base/version.h"
#include "base/xml_text.h"
#include "derate/export_text.h"

namespace heatsoak::derate {
namespace {

struct FmuUnit {
  std::string_view suffix;  ///< suffix of variable names; longer suffixes come first
  std::string_view name;
  std::string_view base;  ///< attributes of the element BaseUnit, the same in FMI 2.0 and 3.0
};
constexpr std::array kUnits{FmuUnit{"_rad_per_s2", "rad/s2", R"(rad="1" s="-2")"},
                            FmuUnit{"_rad_per_s", "rad/s", R"(rad="1" s="-1")"},
                            FmuUnit{"_m_per_s", "m/s", R"(m="1" s="-1")"},
                            FmuUnit{"_A", "A", R"(A="1")"},
                            FmuUnit{"_C", "degC", R"(K="1" offset="273.15")"},
                            FmuUnit{"_h", "h", R"(s="1" factor="3600")"},
                            FmuUnit{"_s", "s", R"(s="1")"}};

std::string number(double value) { return fmt::format("{}", rounded_to_12_digits(value)); }

std::string units(const FmuModel& model) {
  std::set<std::string_view> used;
  for (const FmuVariable& each : model.variables) {
    used.insert(each.unit);
  }
  std::string text = "  <UnitDefinitions>\n";
  for (const FmuUnit& each : kUnits) {
    if (used.contains(each.name)) {
      text += fmt::format("    <Unit name=\"{}\"><BaseUnit {}/></Unit>\n", each.name, each.base);
    }
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
  return (variable.unit.empty() ? "" : fmt::format(" unit=\"{}\"", variable.unit)) +
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

std::string_view fmu_unit(std::string_view variable) {
  for (const FmuUnit& each : kUnits) {
    if (variable.ends_with(each.suffix)) {
      return each.name;
    }
  }
  return {};
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
