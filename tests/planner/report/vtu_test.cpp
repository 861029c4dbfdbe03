#include "planner/report/vtu.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

/// Content of a file in the temporary folder after `write` has written it.
template <class Write>
std::string written(const Write& write) {
  const auto file =
      std::filesystem::temp_directory_path() /
      (std::string("drapeplan_vtu_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  write(file);
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::filesystem::remove(file);
  return text;
}

std::vector<unsigned char> decode(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | std::uint32_t(digits.find(c));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes.push_back(static_cast<unsigned char>(group >> bits & 0xffu));
    }
  }
  return bytes;
}

/// Values of the data array `name` of a written file; its length field must fit.
template <class Value>
std::vector<Value> values_of(const std::string& text, const std::string& name) {
  const size_t at = text.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return {};
  const size_t begin = text.find('>', at) + 1, end = text.find('<', begin);
  const std::vector<unsigned char> bytes = decode(text.substr(begin, end - begin));
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  EXPECT_EQ(size, bytes.size() - sizeof size) << name;
  EXPECT_EQ((end - begin) % 4, 0u) << name;
  std::vector<Value> values(size / sizeof(Value));
  if (!values.empty()) std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

Snapshot flat(const Mesh& mesh) {
  Snapshot snapshot;
  for (const auto& uv : mesh.rest) snapshot.position.emplace_back(uv.x(), uv.y(), 1.0 / 3);
  return snapshot;
}

TEST(Vtu, PlyReadsBackBitForBit) {
  const Mesh mesh = rectangle_mesh(0.03, 0.02, 0.01);
  Snapshot snapshot = flat(mesh);
  snapshot.director.assign(mesh.rest.size(), Eigen::Vector3d(0, 0.6, 0.8));
  snapshot.shear = {0.1, -0.2, 1e-300, 4, 5, std::numeric_limits<double>::denorm_min()};
  std::vector<double> gap(mesh.rest.size());
  for (size_t k = 0; k < gap.size(); ++k) gap[k] = 0.1 / double(k + 1);
  const std::string text = written([&](const auto& file) { write_vtu(file, mesh, snapshot, gap); });

  EXPECT_NE(text.find("NumberOfPoints=\"12\" NumberOfCells=\"6\""), std::string::npos);
  const std::vector<double> points = values_of<double>(text, "points");
  ASSERT_EQ(points.size(), 36u);
  for (size_t node = 0; node < 12; ++node) {
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(points[3 * node + k], snapshot.position[node][Eigen::Index(k)]);
  }
  EXPECT_EQ(values_of<double>(text, "gap"), gap);
  EXPECT_EQ(values_of<double>(text, "shear"), snapshot.shear);
  EXPECT_EQ(values_of<double>(text, "director").size(), 36u);
  const auto connectivity = values_of<std::int64_t>(text, "connectivity");
  ASSERT_EQ(connectivity.size(), 24u);
  for (size_t k = 0; k < 24; ++k) EXPECT_EQ(connectivity[k], mesh.quads[k / 4][k % 4]);
  EXPECT_EQ(values_of<std::int64_t>(text, "offsets"), (std::vector<std::int64_t>{4, 8, 12, 16, 20, 24}));
  EXPECT_EQ(values_of<std::uint8_t>(text, "types"), std::vector<std::uint8_t>(6, 9));
}

TEST(Vtu, FieldsThatAreAbsentAreNotWritten) {
  const Mesh mesh = rectangle_mesh(0.03, 0.02, 0.01);
  const std::string text = written([&](const auto& file) { write_vtu(file, mesh, flat(mesh)); });
  for (const char* name : {"gap", "director", "shear", "warp_strain", "weft_strain"}) {
    EXPECT_EQ(text.find(name), std::string::npos) << name;
  }
}

TEST(Vtu, FieldOfTheWrongSizeIsRefused) {
  const Mesh mesh = rectangle_mesh(0.03, 0.02, 0.01);
  Snapshot snapshot = flat(mesh);
  snapshot.shear = {1};
  EXPECT_THROW(write_vtu("never_written.vtu", mesh, snapshot), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists("never_written.vtu"));
}

TEST(Vtu, FolderThatDoesNotExistIsNamed) {
  const Mesh mesh = rectangle_mesh(0.03, 0.02, 0.01);
  try {
    write_vtu("no_such_folder/ply.vtu", mesh, flat(mesh));
    FAIL() << "should have thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_folder/ply.vtu"), std::string::npos) << error.what();
  }
}

TEST(Vtu, MoldIsAGridOverItsExtent) {
  const Mold mold(PlaneShape{0.2}, Extent{{0, 0}, {0.4, 0.2}});
  const std::string text = written([&](const auto& file) { write_mold_vtu(file, mold, 5); });
  EXPECT_NE(text.find("NumberOfPoints=\"25\" NumberOfCells=\"16\""), std::string::npos);
  const std::vector<double> points = values_of<double>(text, "points");
  EXPECT_LE(
      std::abs(points[72] - 0.4) + std::abs(points[73] - 0.2) + std::abs(points[74] - mold.height(0.4, 0.2)),
      1e-15);
  for (const double curvature : values_of<double>(text, "gaussian_curvature")) EXPECT_EQ(curvature, 0.0);
}

TEST(Vtu, MoldIsLeftOutWhereItIsNotDefined) {
  const Mold dome(SphereShape{{0, 0, 0}, 1}, Extent{{-2, -2}, {2, 2}});
  const std::string text = written([&](const auto& file) { write_mold_vtu(file, dome, 21); });
  const std::vector<double> points = values_of<double>(text, "points");
  EXPECT_GT(points.size(), 0u);
  for (const double coordinate : points) EXPECT_LE(std::abs(coordinate), 1.0 + 1e-12);
  for (const std::int64_t node : values_of<std::int64_t>(text, "connectivity")) {
    EXPECT_TRUE(node >= 0 && node < std::int64_t(points.size() / 3));
  }
}

TEST(Vtu, CollectionKeepsAllDigitsOfItsTimes) {
  const double later = 1 + std::numeric_limits<double>::epsilon();
  const std::string text = written([&](const auto& file) {
    write_pvd(file, {{1e-7, "a.vtu"}, {later, "b & \"c\".vtu"}});
  });
  EXPECT_NE(text.find("timestep=\"1e-07\""), std::string::npos) << text;
  EXPECT_NE(text.find("timestep=\"1.0000000000000002\""), std::string::npos) << text;
  EXPECT_NE(text.find("file=\"b &amp; &quot;c&quot;.vtu\""), std::string::npos) << text;
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
