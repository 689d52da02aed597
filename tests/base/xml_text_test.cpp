#include "base/xml_text.h"

#include <expat.h>
#include <gtest/gtest.h>

#include <memory>

#include "base/random.h"

namespace heatsoak::base {
namespace {

/// Result of parsing a document with Expat: the text of its element and the value of its attribute, or a flag that it is not well-formed.
struct Parsed {
  bool is_well_formed = false;
  std::string text;
  std::string attribute;
};

Parsed parsed(const std::string& document) {
  Parsed result;
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate("UTF-8"), &XML_ParserFree);
  XML_SetUserData(parser.get(), &result);
  XML_SetElementHandler(
      parser.get(), [](void* data, const char*, const char** names) { static_cast<Parsed*>(data)->attribute = names[1]; },
      [](void*, const char*) {});
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* text, int size) {
    static_cast<Parsed*>(data)->text.append(text, static_cast<std::size_t>(size));
  });
  result.is_well_formed = XML_Parse(parser.get(), document.data(), static_cast<int>(document.size()), 1) == XML_STATUS_OK;
  return result;
}

Parsed through_xml(const std::string& text) { return parsed("<a b=\"" + xml_attribute(text) + "\">" + xml_text(text) + "</a>"); }

TEST(XmlText, valid_text_returns_from_a_parser_as_it_was) {
  for (const std::string text : {"", "plain", "a < b && c > \"d\" 'e'", "two\nlines", "52 °C … 3 µΩ, 日本, 🤖", "&lt;", "]]>"}) {
    const Parsed result = through_xml(text);
    EXPECT_TRUE(result.is_well_formed) << text;
    EXPECT_EQ(result.text, text);
    EXPECT_EQ(result.attribute, text);
  }
}

TEST(XmlText, any_bytes_give_a_well_formed_document) {
  Random random(7, 0);
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (double size = 12.0 * random.uniform(); size > 0.0; size -= 1.0) {
      text += static_cast<char>(static_cast<unsigned char>(256.0 * random.uniform()));
    }
    EXPECT_TRUE(through_xml(text).is_well_formed) << ::testing::PrintToString(text);
  }
}

TEST(XmlText, what_xml_does_not_allow_is_replaced) {
  EXPECT_EQ(xml_text(std::string_view("a\0b\x01\x1f", 5)), "ab");
  EXPECT_EQ(xml_text("\xff\xc3"), "??");
  EXPECT_EQ(xml_text("\xc0\x80"), "??");
  EXPECT_EQ(xml_text("\xed\xa0\x80"), "???");  // half of a surrogate pair
}

}  // namespace
}  // namespace heatsoak::base
