// Writers of mold files, for tests.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "mapping/surface/triangles.hpp"

namespace drapeplan {

/// A folder of this test that goes away.
struct ScratchFolder {
  std::filesystem::path path;
  ScratchFolder() {
    static int count = 0;
    path = std::filesystem::path(testing::TempDir()) / fmt::format("molds_test_{}_{}", ::getpid(), count++);
    std::filesystem::create_directories(path);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return path / name;
  }
};

inline std::string text_stl(const Triangles& mesh) {
  std::string text = "solid mold\n";
  for (const auto& corners : mesh.corners) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : corners) {
      const Eigen::Vector3d& v = mesh.vertices[size_t(k)];
      text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", v.x(), v.y(), v.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid mold\n";
}

inline std::string binary_stl(const Triangles& mesh) {
  std::string bytes(80, ' ');
  const auto append = [&bytes](const auto& value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    bytes.append(raw.data(), raw.size());
  };
  append(std::uint32_t(mesh.corners.size()));
  for (const auto& corners : mesh.corners) {
    for (int k = 0; k < 3; ++k) append(0.0F);
    for (const int k : corners) {
      for (const double coordinate : mesh.vertices[size_t(k)]) append(float(coordinate));
    }
    append(std::uint16_t(0));
  }
  return bytes;
}

inline std::string obj(const Triangles& mesh) {
  std::string text;
  for (const auto& v : mesh.vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", v.x(), v.y(), v.z());
  for (const auto& c : mesh.corners) text += fmt::format("f {} {} {}\n", c[0] + 1, c[1] + 1, c[2] + 1);
  return text;
}

/// Rows x, y, z of the vertices.
inline std::string points_csv(const Triangles& mesh) {
  std::string text = "x,y,z\n";
  for (const auto& v : mesh.vertices) text += fmt::format("{:.12g},{:.12g},{:.12g}\n", v.x(), v.y(), v.z());
  return text;
}

}  // namespace drapeplan
