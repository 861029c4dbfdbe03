// What a VTU file holds, for tests: its arrays by name.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "planner/base/base64.hpp"

namespace drapeplan::test {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Values of the data array `name` of a VTU file; its length field must fit. Empty if there is none.
template <class Value = double>
std::vector<Value> values_of(const std::string& text, const std::string& name) {
  const size_t at = text.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return {};
  const size_t begin = text.find('>', at) + 1, end = text.find('<', begin);
  const auto bytes = bytes_of_base64(text.substr(begin, end - begin));
  std::uint64_t size = 0;
  if (!bytes || bytes->size() < sizeof size) {
    ADD_FAILURE() << name << " is no base64 of a length and values";
    return {};
  }
  std::memcpy(&size, bytes->data(), sizeof size);
  EXPECT_EQ(size, bytes->size() - sizeof size) << name;
  std::vector<Value> values(size / sizeof(Value));
  if (!values.empty()) std::memcpy(values.data(), bytes->data() + sizeof size, size);
  return values;
}

/// Names of the arrays between <TAG> and </TAG>: "PointData", "CellData".
inline std::vector<std::string> arrays_of(const std::string& text, const std::string& tag) {
  const size_t begin = text.find("<" + tag + ">"), end = text.find("</" + tag + ">");
  std::vector<std::string> names;
  const std::string mark = "Name=\"";
  for (size_t at = text.find(mark, begin); at < end; at = text.find(mark, at + 1)) {
    const size_t name = at + mark.size();
    names.push_back(text.substr(name, text.find('"', name) - name));
  }
  return names;
}

/// A folder of its own for each test, removed at its end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::path(testing::TempDir()) /
              ("drapeplan_" + std::to_string(::getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace drapeplan::test
