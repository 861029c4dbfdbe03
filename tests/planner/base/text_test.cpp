#include "planner/base/text.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace drapeplan
