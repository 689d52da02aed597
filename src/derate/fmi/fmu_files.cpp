#include <embedded/fmi_sources.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/xml_text.h"
#include "derate/export_text.h"
#include "derate/fmi/description.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate {
namespace {

constexpr std::array<std::string_view, 5> kKinds{"kind_independent", "kind_input", "kind_parameter", "kind_output", "kind_constant"};
constexpr std::array<std::string_view, 3> kTypes{"type_real", "type_boolean", "type_enumeration"};

bool is_motor(const FmuModel& model) { return model.items.empty(); }

/// True if the file of sources/ is part of a unit of this FMI version and kind.
bool belongs(std::string_view name, const FmuModel& model, FmiVersion version) {
  if (name.starts_with("fmi")) {
    return name.starts_with(version == FmiVersion::fmi2 ? "fmi2" : "fmi3");
  }
  return name != (is_motor(model) ? "guard.c" : "motor.c");
}

std::string documentation(const FmuModel& model) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title></head>\n<body>\n<h1>{0}</h1>\n<p>{1}</p>\n"
      "<pre>\n{2}</pre>\n<table>\n<tr><th>variable</th><th>unit</th><th>meaning</th></tr>\n",
      base::xml_text(model.identifier), base::xml_text(model.description), base::xml_text(model.provenance));
  for (const FmuVariable& each : model.variables) {
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", each.name, fmu_unit(each), base::xml_text(each.description));
  }
  return text + "</table>\n<p>Inputs are held over a communication step. Temperatures are in degrees Celsius.</p>\n</body>\n</html>\n";
}

}  // namespace

std::string fmu_number(double value) {
  std::string text = fmt::format("{}", rounded_to_12_digits(value));
  if (text.find_first_of(".en") == std::string::npos) {
    text += ".0";
  }
  return text.front() == '-' ? fmt::format("({})", text) : text;
}

std::vector<FmuFile> fmu_tables(const FmuModel& model, std::string_view more) {
  std::string header = fmt::format(
      "/* {} */\n#ifndef MODEL_DATA_H\n#define MODEL_DATA_H\n\n#define MODEL_TOKEN \"{}\"\n#define MODEL_TOKEN_SIZE {}\n\n"
      "/* value references */\nenum {{\n",
      model.identifier, model.token, model.token.size() + 1);
  std::string table = "#include \"model.h\"\n\nconst model_variable model_variables[MODEL_VARIABLES] = {\n";
  for (const FmuVariable& each : model.variables) {
    header += fmt::format("  at_{},\n", each.name);
    table += fmt::format("    {{{}, {}, {}}}, /* {} */\n", kKinds.at(static_cast<std::size_t>(each.causality)),
                         kTypes.at(static_cast<std::size_t>(each.type)), fmu_number(each.value), each.name);
  }
  header += fmt::format("  MODEL_VARIABLES\n}};\n\n{}\n#endif\n", more);
  return {{"model_data.h", header}, {"model_data.c", table + "};\n"}};
}

std::vector<FmuFile> fmu_files(const FmuModel& model, FmiVersion version) {
  std::vector<FmuFile> files{{"documentation/index.html", documentation(model)}};
  std::vector<std::string> compiled;
  const auto add = [&](const std::string& name, std::string content) {
    if (name.ends_with(".c")) {
      compiled.push_back(name);
    }
    files.push_back({"sources/" + name, std::move(content)});
  };
  for (const embedded::Text& text : embedded::fmi_sources()) {
    const std::string name = std::filesystem::path(text.path).filename();
    if (belongs(name, model, version)) {
      add(name, std::string(text.text));
    }
  }
  for (const FmuFile& each : model.sources) {
    add(each.path, each.content);
  }
  std::ranges::sort(compiled);
  files.push_back({"modelDescription.xml", version == FmiVersion::fmi2 ? description_fmi2(model, compiled) : description_fmi3(model)});
  if (version == FmiVersion::fmi3) {
    files.push_back({"sources/buildDescription.xml", build_description_fmi3(model, compiled)});
  }
  std::ranges::sort(files, {}, &FmuFile::path);
  return files;
}

}  // namespace heatsoak::derate
