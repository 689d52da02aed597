#include "present/measured/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace heatsoak::present {
namespace {

/// Returns the verdict as a sentence.
std::string headline_of(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : diagnosis.effects) {
    names.push_back(effect.id);
  }
  switch (diagnosis.verdict) {
    case DiagnosisVerdict::nothing_missing:
      return "No effect is missing.";
    case DiagnosisVerdict::effect_found:
      return fmt::format("The model lacks {}.", fmt::join(names, " and "));
    case DiagnosisVerdict::unexplained:
      return "Heat is missing that no effect of the catalogue explains.";
    case DiagnosisVerdict::not_identifiable:
      break;
  }
  return "These runs do not determine whether an effect is missing.";
}

}  // namespace

Document diagnosis_document(const Diagnosis& diagnosis, std::span<const std::string> warnings, std::span<const std::string> of_logs) {
  Document document{.headline = {{headline_of(diagnosis)}}, .paragraphs = diagnosis.words};
  for (const std::string& each : warnings) {
    document.add_note(Severity::warning, each);
  }
  for (const std::string& note : diagnosis.notes) {
    const bool is_of_logs = std::ranges::find(of_logs, note) != of_logs.end();
    document.add_note(is_of_logs ? Severity::background : Severity::note, note);
  }
  return document;
}

}  // namespace heatsoak::present
