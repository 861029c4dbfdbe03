#include "planner/base/text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

namespace drapeplan {
namespace {

using namespace std::string_literals;

TEST(Text, ThePrefixInUtf8EndsAtTheFirstByteThatIsNoCharacter) {
  EXPECT_EQ(utf8_prefix(""), 0U);
  EXPECT_EQ(utf8_prefix("a\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80"), 10U);
  for (const char* bad :
       {"\x80", "\xC3", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
        "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xFE", "\xFF", "\xE2\x82z"}) {
    EXPECT_EQ(utf8_prefix("ab"s + bad), 2U) << bad;
  }
}

TEST(Text, CleanTextReplacesWhatXmlDoesNotAllow) {
  EXPECT_EQ(clean_text("sm\xC3\xB8rrebr\xC3\xB8"
                       "d\n\t"),
            "sm\xC3\xB8rrebr\xC3\xB8"
            "d\n\t");
  EXPECT_EQ(clean_text("caf\xe9.json"), "caf\uFFFD.json");
  EXPECT_EQ(clean_text("a\0b\x1b[31m\r"s), "a\uFFFDb\uFFFD[31m\uFFFD");
  EXPECT_EQ(clean_text("\xEF\xBF\xBE\xEF\xBF\xBF"), "\uFFFD\uFFFD");  // U+FFFE and U+FFFF
  EXPECT_EQ(clean_text("\xE2\x82"), "\uFFFD\uFFFD");                  // a character that is cut off
}

TEST(Text, AnyBytesBecomeValidMarkup) {
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(random() % 20, ' ');
    for (char& byte : bytes) byte = char(random() % 256);
    const std::string markup = escape_markup(bytes);
    EXPECT_EQ(utf8_prefix(markup), markup.size());
    EXPECT_EQ(clean_text(markup), markup);
    EXPECT_EQ(markup.find_first_of("<>\"'"), std::string::npos);
  }
}

TEST(Text, NumbersReadBackAndEscapesAreComplete) {
  for (const double value : {0.1, -0.0, 1e-320, 1e308, 1.0 / 3})
    EXPECT_EQ(std::strtod(exact(value).c_str(), nullptr), value);
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-1.005, 1), "-1.0");
  EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 1), "\u2013");
  EXPECT_EQ(escape_markup("<a href=\"x\">'&\x01"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;\uFFFD");
}

}  // namespace
}  // namespace drapeplan
