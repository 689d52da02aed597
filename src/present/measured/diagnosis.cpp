#include "present/measured/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <variant>

#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"

namespace heatsoak::present {

Document diagnosis_document(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings) {
  std::string verdict = verdict_words(answer.diagnosis) + ".";
  verdict.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(verdict.front())));
  Document document{.headline = {{verdict}}, .paragraphs = diagnosis_words(answer)};
  for (const diagnosis::DiagnosisFinding& each : answer.findings) {
    if (const auto* const odd = std::get_if<calibration::ContradictingRun>(&each); odd != nullptr && odd->is_left_out) {
      document.headline.push_back({fmt::format("This is the answer without {}, which contradicts the other runs.", odd->run)});
    }
  }
  std::vector<Note> notes = diagnosis_notes(answer, readings);
  std::ranges::stable_partition(notes, [](const Note& each) { return each.severity == Severity::warning; });
  for (const Note& each : notes) {
    document.add_note(each.severity, each.words);
  }
  document.data = diagnosis_json(answer, readings);
  return document;
}

}  // namespace heatsoak::present
