#include "planner/base/base64.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace drapeplan {
namespace {

std::vector<unsigned char> bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

/// RFC 4648, section 10.
TEST(Base64, IsTheOneOfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : vectors) {
    EXPECT_EQ(base64(bytes(plain)), text);
    ASSERT_TRUE(bytes_of_base64(text)) << text;
    EXPECT_EQ(*bytes_of_base64(text), bytes(plain));
  }
}

TEST(Base64, GivesBackEveryByte) {
  std::vector<unsigned char> all;
  for (int k = 0; k < 256; ++k) all.push_back(static_cast<unsigned char>(k));
  for (; !all.empty(); all.pop_back()) {
    const auto back = bytes_of_base64(base64(all));
    ASSERT_TRUE(back);
    ASSERT_EQ(*back, all);
  }
}

TEST(Base64, RefusesWhatItDoesNotWrite) {
  for (const char* text :
       {"A", "AB", "ABC", "AB=C", "A===", "AB\n=", "A*BC", "====", "Zg==Zg==", "Zh==", "Zm9="})
    EXPECT_FALSE(bytes_of_base64(text)) << text;
}

}  // namespace
}  // namespace drapeplan
