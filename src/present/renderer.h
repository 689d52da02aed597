// Renderers: each formats a document in one way. One file in src/present/renderers each.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "present/document.h"

namespace heatsoak::present {

/// Number of notes shown on the terminal; further ones are counted, and shown with --explain.
inline constexpr std::size_t kMostNotes = 3;

struct RenderOptions {
  std::size_t width = 80;  ///< characters; at least kLeastWidth
  bool with_colors = false;
  bool is_terminal = false;  ///< false for files and pipes
  bool breaks_rows = true;   ///< false: each row of a table is one line, because a pipe has no width
  bool explains = false;     ///< show every note
  bool is_quiet = false;     ///< show only the headline; without one, the first column of the tables, for scripts
};

inline constexpr std::size_t kLeastWidth = 20;

struct Renderer {
  std::string_view name;         ///< name of its source file; set by all_renderers()
  std::string_view file_ending;  ///< ".md"; empty: used for the terminal only
  std::string_view summary;
  std::string (*render)(const Document& document, const RenderOptions& options) = nullptr;
};
const std::vector<Renderer>& all_renderers();

/// Formats the document for a terminal of `options.width` characters. Control characters are replaced by '?'.
std::string terminal_text(const Document& document, const RenderOptions& options);

/// Formats the whole document for the file's extension. Throws Failure (bad_input) that lists the known extensions.
std::string rendered_for(const std::string& file, const Document& document);
/// Formats the whole document with the renderer of this name, such as "json".
std::string rendered_as(std::string_view name, const Document& document);

/// Sorts notes by falling severity; the order within one severity is kept.
std::vector<Note> by_urgency(std::vector<Note> notes);

/// Returns the meanings of the given columns as the words of a note; empty if none has a meaning.
std::string legend_of(const Table& table, std::span<const std::size_t> shown);
/// Returns the notes by urgency, and at the end the legends of all columns of all tables.
std::vector<Note> notes_with_legends(const Document& document);

}  // namespace heatsoak::present
