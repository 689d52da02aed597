#include "present/measured/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "present/measured/diagnosis_words.h"

namespace heatsoak::present {
namespace {

/// Returns the verdict as a sentence.
std::string headline_of(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  bool is_class = false;
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    if (!effect.is_from_catalogue) {
      continue;
    }
    is_class = is_class || !effect.confusable_with.empty();
    names.push_back(effect.confusable_with.empty() ? effect.id
                                                   : fmt::format("{} or {}", effect.id, fmt::join(effect.confusable_with, " or ")));
  }
  const std::string lacks =
      fmt::format("The model lacks {}{}", fmt::join(names, " and "), is_class ? ", which these runs do not distinguish" : "");
  switch (diagnosis.verdict) {
    case diagnosis::DiagnosisVerdict::nothing_missing:
      return "No effect is missing.";
    case diagnosis::DiagnosisVerdict::effect_found:
      return lacks + ".";
    case diagnosis::DiagnosisVerdict::unexplained:
      return names.empty() ? "Heat is missing that no effect of the catalogue explains."
                           : lacks + ", and further heat that no effect of the catalogue explains.";
    case diagnosis::DiagnosisVerdict::not_identifiable:
      break;
  }
  return "These runs do not determine whether an effect is missing.";
}

}  // namespace

Document diagnosis_document(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings) {
  Document document{.headline = {{headline_of(answer.diagnosis)}}, .paragraphs = diagnosis_words(answer)};
  std::vector<Note> notes = diagnosis_notes(answer, readings);
  std::ranges::stable_partition(notes, [](const Note& each) { return each.severity == Severity::warning; });
  for (const Note& each : notes) {
    document.add_note(each.severity, each.words);
  }
  return document;
}

}  // namespace heatsoak::present
