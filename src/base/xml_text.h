// Text as content of XML and HTML files.
#pragma once

#include <string>
#include <string_view>

namespace heatsoak::base {

/// Returns `text` as content of an element: escapes < > & and ". Drops control characters, which XML does not allow, except newline and
/// tab. Replaces invalid UTF-8 by a question mark.
std::string xml_text(std::string_view text);

/// Returns `text` as value of an attribute in double quotes: as xml_text(), with newlines as character references.
std::string xml_attribute(std::string_view text);

}  // namespace heatsoak::base
