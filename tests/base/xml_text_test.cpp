#include "base/xml_text.hpp"

#include <gtest/gtest.h>

namespace bough {
namespace {

TEST(XmlText, HoldsOnlyWhatXmlTakes) {
  EXPECT_EQ(escape_xml("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escape_xml(std::string("a\x01\0\x1f\x7f\tb\n", 8)), "a\tb\n");
  EXPECT_EQ(escape_xml("\u00fc \u20ac \U0001F600"), "\u00fc \u20ac \U0001F600");
  // Not UTF-8: latin-1, cut short, too long a form, half of a pair, past the last character.
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(escape_xml("\xFC"), bad);
  EXPECT_EQ(escape_xml("\xE2\x82"), bad + bad);
  EXPECT_EQ(escape_xml("\xC0\xAF"), bad + bad);
  EXPECT_EQ(escape_xml("\xED\xA0\x80"), bad + bad + bad);
  EXPECT_EQ(escape_xml("\xF4\x90\x80\x80"), bad + bad + bad + bad);
  EXPECT_EQ(escape_xml("\xEF\xBF\xBF"), bad + bad + bad);
}

}  // namespace
}  // namespace bough
