#include "present/document.h"

namespace heatsoak::present {

void Document::add_note(Severity severity, std::string_view words) {
  Note note;
  note.severity = severity;
  note.words = words;
  notes.push_back(std::move(note));
}

Document short_answer(std::string sentence, Json data) { return {.headline = {{std::move(sentence)}}, .data = std::move(data)}; }

}  // namespace heatsoak::present
