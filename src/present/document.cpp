#include "present/document.h"

#include <algorithm>

namespace heatsoak::present {

void Document::add_note(Severity severity, std::string_view words) {
  if (std::ranges::find(notes, words, &Note::words) != notes.end()) {
    return;
  }
  Note note;
  note.severity = severity;
  note.words = words;
  notes.push_back(std::move(note));
}

}  // namespace heatsoak::present
