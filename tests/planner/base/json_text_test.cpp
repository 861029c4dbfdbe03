#include "planner/base/json_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;
using namespace std::string_literals;

/// All faults, one "line:column pointer: message" per line of the result.
std::string faults_of(const std::string& text) {
  std::string all;
  for (const TextFault& fault : parse_json_text(text).faults) {
    all += std::to_string(fault.line) + ":" + std::to_string(fault.column) + " " + fault.pointer + ": " +
           fault.message + "\n";
  }
  return all;
}

/// Wants exactly one fault that starts so and has this in it.
void expect_fault(const std::string& text, const std::string& start, const std::string& part) {
  const std::string faults = faults_of(text);
  EXPECT_TRUE(faults.starts_with(start)) << faults;
  EXPECT_NE(faults.find(part), std::string::npos) << faults;
  EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 1) << faults;
}

TEST(JsonText, EveryValueHasTheLineOfItsKeyOrInListsItsOwn) {
  const ParsedText parsed = parse_json_text("\n{\"a\": 1\n,\r\n\"b\"\n:\n[2,\n3\n,[],\n{\"c/~\":\ntrue}]}\n");
  ASSERT_TRUE(parsed.faults.empty());
  EXPECT_EQ(parsed.value, (json{{"a", 1}, {"b", {2, 3, json::array(), {{"c/~", true}}}}}));
  const std::map<std::string, int> lines{{"", 2},     {"/a", 2},   {"/b", 4},   {"/b/0", 6},
                                         {"/b/1", 7}, {"/b/2", 8}, {"/b/3", 9}, {"/b/3/c~1~0", 9}};
  EXPECT_EQ(parsed.lines, lines);
}

TEST(JsonText, NumbersThatEndALineOrTheTextStandOnTheirLine) {
  EXPECT_EQ(parse_json_text("\n\n17").lines.at(""), 3);
  EXPECT_EQ(parse_json_text("[1\n,2.5\n,-3e2\n]").lines.at("/2"), 3);
  EXPECT_EQ(parse_json_text("[1\n\n\n,2]").lines.at("/1"), 4);
}

TEST(JsonText, ValuesAreThoseOfTheLibrary) {
  for (const char* text : {"null", "true", "\"\\u00e9\\ud83d\\ude00\"", "18446744073709551615",
                           "-9223372036854775808", "99999999999999999999", "-0.0", "5e-324", "0e-999", "{}",
                           "[]", "[[],{},[{}]]", "{\"\":{\"\":[1,\"x\",null,false,1e300]}}"}) {
    const ParsedText parsed = parse_json_text(text);
    EXPECT_TRUE(parsed.faults.empty()) << text;
    EXPECT_EQ(dump_json(parsed.value), json::parse(text).dump());
  }
}

TEST(JsonText, SyntaxErrorsHaveLineAndColumn) {
  expect_fault("", "1:1 : ", "syntax error");
  expect_fault("{\n  \"a\": 405mm\n}", "2:11 : ", "syntax error while parsing object");
  expect_fault("[1,\n2 3]", "2:3 : ", "expected ']'");
  expect_fault("[1]\n[2]", "2:1 : ", "expected end of input");
  expect_fault("[1, // one\n2]", "1:5 : ", "syntax error");
  expect_fault("{\"a\": [1, 2", "1:12 : ", "unexpected end of input");
  expect_fault("[\"\\ud800\"]", "1:9 : ", "surrogate");
  expect_fault("[\"\\udc00\"]", "1:8 : ", "surrogate");
  expect_fault("[\"a\nb\"]", "1:4 : ", "control character");
  EXPECT_TRUE(parse_json_text("{\"a\": [1, 2").value.is_null());
}

TEST(JsonText, NumbersThatNoDoubleHoldsAreRefused) {
  expect_fault("[\n1e400]", "2:", "number overflow parsing '1e400'");
  expect_fault("[\n-1e400]", "2:", "number overflow parsing '-1e400'");
  expect_fault("[0,\n1e-400]", "2:0 /1: ", "number underflow parsing '1e-400'");
  expect_fault(fmt::format("[{:9>400}]", ""), "1:", "number overflow");
}

TEST(JsonText, KeysThatAppearTwiceAreAllNamed) {
  EXPECT_EQ(faults_of("{\"a\": 1,\n\"b\": {\"c\": 1,\n \"c\": 2, \"a\": 3},\n\"a\": {}}"),
            "3:0 /b/c: the key \"c\" appears twice in this object; first on line 2\n"
            "4:0 /a: the key \"a\" appears twice in this object; first on line 1\n");
  // The same key in two objects, also in those of a doubled key; and in another spelling.
  EXPECT_EQ(faults_of("{\"a\": {\"b\": 1},\n\"\\u0061\": {\"b\": 2}}"),
            "2:0 /a: the key \"a\" appears twice in this object; first on line 1\n");
  EXPECT_EQ(faults_of("[{\"0\": {\"x\": 1}}, {\"0\": {\"x\": 1}}, [[]]]"), "");
}

TEST(JsonText, NestingIsLimited) {
  const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(faults_of(nested(64)), "");
  expect_fault(fmt::format("\n{}", nested(65)), "2:0 /0/0/", "nested deeper than 64 levels");
  expect_fault(std::string(2000000, '['), "1:0 ", "nested deeper than 64 levels");
  std::string objects;
  for (int k = 0; k < 65; ++k) objects += "{\"a\":\n";
  expect_fault(objects, "65:0 /a/a/", "nested deeper than 64 levels");
}

TEST(JsonText, OnlyPlainUtf8IsRead) {
  expect_fault("{\n\"caf\xe9\": 1}", "2:5 : ", "the byte 0xE9 is not text in UTF-8");
  expect_fault("\xEF\xBB\xBF{}", "1:1 : ", "byte order mark");
  expect_fault("\xFF\xFE{\0}\0"s, "1:1 : ", "UTF-16");
  expect_fault("\0{\0}"s, "1:1 : ", "UTF-16");
  expect_fault("{\0}\0"s, "1:2 : ", "UTF-16");
  expect_fault("{}\n\0 anything"s, "2:1 : ", "the byte 0x00");
  expect_fault("[\"\xC0\x80\"]", "1:3 : ", "0xC0");          // a longer form than needed
  expect_fault("[\"\xED\xA0\x80\"]", "1:3 : ", "0xED");      // a surrogate
  expect_fault("[\"\xF4\x90\x80\x80\"]", "1:3 : ", "0xF4");  // beyond the last character
  expect_fault("[\"\xF0\x9F\x98\"]", "1:3 : ", "0xF0");      // cut off
  expect_fault("{\"a\\u0000b\": 1}", "1:0 /a", "NUL");
  expect_fault("[1,\n\"\\u0000\"]", "2:0 /1: ", "NUL");
  EXPECT_EQ(parse_json_text("[\"\xF0\x9F\x98\x80 \xC3\xA9\"]").faults.size(), 0U);
  EXPECT_EQ(faults_of("\xC3\xA9").find("\xC3'"), std::string::npos) << "half a character in a message";
}

TEST(JsonText, CheckedJsonThrowsTheFirstFaultWithItsPlace) {
  EXPECT_EQ(checked_json("{\"a\": [1]}"), (json{{"a", {1}}}));
  const auto what = [](const std::string& text) {
    try {
      checked_json(text);
    } catch (const WrongInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(what("{\"a\": 1, \"a\": 2}"), "/a: the key \"a\" appears twice in this object; first on line 1");
  EXPECT_TRUE(what("[1,]").starts_with("column 4: syntax error")) << what("[1,]");
  EXPECT_TRUE(what("\n[1,]").starts_with("line 2: column 4: syntax error")) << what("\n[1,]");
}

TEST(JsonText, WhatGoesOutIsUtf8) {
  EXPECT_EQ(dump_json(json{{"caf\xe9", "a\xff\x01z"}}), "{\"caf\uFFFD\":\"a\uFFFD\\u0001z\"}");
  EXPECT_EQ(dump_json(json{1, 2}, 1), "[\n 1,\n 2\n]");
}

}  // namespace
}  // namespace drapeplan
