// A renderer: one way to show a document. One file in src/present/renderers each.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "present/document.h"

namespace heatsoak::present {

/// Reading time of a terminal user: further notes are counted, and shown with --explain.
inline constexpr std::size_t kMostNotes = 3;

struct RenderOptions {
  std::size_t width = 80;  ///< in characters; at least kLeastWidth
  bool with_colors = false;
  bool explains = false;  ///< show every note
  bool is_quiet = false;  ///< show the headline alone
};

inline constexpr std::size_t kLeastWidth = 20;

struct Renderer {
  std::string_view name;         ///< the file's name; set by all_renderers()
  std::string_view file_ending;  ///< ".md"; empty: for the terminal only
  std::string_view summary;
  std::string (*render)(const Document& document, const RenderOptions& options) = nullptr;
};
const std::vector<Renderer>& all_renderers();

/// The document as text for a terminal of `options.width` characters. Control characters in the document are shown as '?'.
std::string terminal_text(const Document& document, const RenderOptions& options);

/// The whole document in the format of the file's ending. Throws Failure (bad_input) that lists the known endings.
std::string rendered_for(const std::string& file, const Document& document);

/// Notes with the most urgent first; those of one severity keep their order.
std::vector<Note> by_urgency(std::vector<Note> notes);

}  // namespace heatsoak::present

namespace heatsoak::renderers {
using present::Renderer;  // for the registry
}
