#include "planner/report/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <span>
#include <stdexcept>

#include "planner/base/base64.hpp"
#include "planner/base/text.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

static_assert(std::endian::native == std::endian::little, "the header of the files says LittleEndian");

constexpr std::uint8_t kVtkQuad = 9;  // a cell type of VTK

/// A data array: inline binary, that is base64 of an 8-byte length and the values.
template <class Value>
std::string data_array(const std::string& name, int components, std::span<const Value> values) {
  const char* type = std::is_same_v<Value, double>         ? "Float64"
                     : std::is_same_v<Value, std::int64_t> ? "Int64"
                                                           : "UInt8";
  const std::uint64_t size = values.size_bytes();
  std::vector<unsigned char> bytes(sizeof size + size);
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return fmt::format(
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
      "format=\"binary\">{}</DataArray>\n",
      type, name, components, base64(bytes));
}

std::string scalars(const std::string& name, const std::vector<double>& values) {
  return data_array<double>(name, 1, values);
}

std::string vectors(const std::string& name, const std::vector<Eigen::Vector3d>& values) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  const double* first = values.empty() ? nullptr : values.front().data();
  return data_array<double>(name, 3, {first, 3 * values.size()});
}

/// An unstructured grid of quadrilaterals.
std::string grid(const std::vector<Eigen::Vector3d>& points, const std::vector<std::array<int, 4>>& cells,
                 const std::string& point_data, const std::string& cell_data) {
  std::vector<std::int64_t> connectivity, offsets;
  for (const auto& cell : cells) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(std::int64_t(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(cells.size(), kVtkQuad);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "      <Points>\n{}      </Points>\n"
      "      <Cells>\n{}{}{}      </Cells>\n"
      "      <PointData>\n{}      </PointData>\n"
      "      <CellData>\n{}      </CellData>\n"
      "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n",
      points.size(), cells.size(), vectors("points", points),
      data_array<std::int64_t>("connectivity", 1, connectivity),
      data_array<std::int64_t>("offsets", 1, offsets), data_array<std::uint8_t>("types", 1, types),
      point_data, cell_data);
}

void check_size(const char* field, size_t size, size_t expected, bool may_be_empty) {
  if (size == expected || (may_be_empty && size == 0)) return;
  throw std::invalid_argument(
      fmt::format("write_vtu: {} has {} entries, expected {}", field, size, expected));
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const Mesh& mesh, const Snapshot& snapshot,
               const std::vector<double>& gap) {
  const size_t nodes = mesh.rest.size(), elements = mesh.quads.size();
  check_size("position", snapshot.position.size(), nodes, false);
  check_size("gap", gap.size(), nodes, true);
  check_size("director", snapshot.director.size(), nodes, true);
  check_size("shear", snapshot.shear.size(), elements, true);
  check_size("warp_strain", snapshot.warp_strain.size(), elements, true);
  check_size("weft_strain", snapshot.weft_strain.size(), elements, true);
  std::string point_data, cell_data;
  if (!gap.empty()) point_data += scalars("gap", gap);
  if (!snapshot.director.empty()) point_data += vectors("director", snapshot.director);
  if (!snapshot.shear.empty()) cell_data += scalars("shear", snapshot.shear);
  if (!snapshot.warp_strain.empty()) cell_data += scalars("warp_strain", snapshot.warp_strain);
  if (!snapshot.weft_strain.empty()) cell_data += scalars("weft_strain", snapshot.weft_strain);
  write_text(file, grid(snapshot.position, mesh.quads, point_data, cell_data));
}

void write_mold_vtu(const std::filesystem::path& file, const Mold& mold, int n) {
  if (n < 2) throw std::invalid_argument(fmt::format("write_mold_vtu: n must be at least 2, it is {}", n));
  std::vector<Eigen::Vector3d> points, normals;
  std::vector<double> curvature;
  std::vector<std::array<int, 4>> cells;
  std::vector<int> index(size_t(n) * size_t(n), -1);  // of each grid point among the points written
  const Eigen::Vector2d lower = mold.extent().lower, size = mold.extent().upper - lower;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = lower.x() + size.x() * i / (n - 1), y = lower.y() + size.y() * j / (n - 1);
      const Eigen::Vector3d normal = mold.normal(x, y);
      const double gaussian = mold.gaussian_curvature(x, y);
      if (!mold.point(x, y).allFinite() || !normal.allFinite() || !std::isfinite(gaussian)) continue;
      index[size_t(i + j * n)] = int(points.size());
      points.push_back(mold.point(x, y));
      normals.push_back(normal);
      curvature.push_back(gaussian);
    }
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const std::array<int, 4> cell{index[size_t(i + j * n)], index[size_t(i + 1 + j * n)],
                                    index[size_t(i + 1 + (j + 1) * n)], index[size_t(i + (j + 1) * n)]};
      if (std::min({cell[0], cell[1], cell[2], cell[3]}) >= 0) cells.push_back(cell);
    }
  }
  write_text(file,
             grid(points, cells, vectors("normal", normals) + scalars("gaussian_curvature", curvature), ""));
}

void write_pvd(const std::filesystem::path& file, const std::vector<PvdEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const PvdEntry& entry : entries) {
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", exact(entry.time),
                        escape_markup(entry.file));
  }
  write_text(file, text + "  </Collection>\n</VTKFile>\n");
}

void write_net(const std::filesystem::path& folder, const Net& net) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const size_t columns = net.u.size(), rows = net.v.size();
  Mesh mesh;
  Snapshot place;
  place.position = net.nodes;
  place.shear = shear_field(net);
  std::vector<double> shear(net.nodes.size(), 0.0), cells(net.nodes.size(), 0.0);
  for (size_t n = 0; n < net.nodes.size(); ++n)
    mesh.rest.emplace_back(net.u[n % columns], net.v[n / columns]);
  for (size_t j = 0; j + 1 < rows; ++j) {
    for (size_t i = 0; i + 1 < columns; ++i) {
      const size_t at = i + j * columns;
      const std::array<size_t, 4> corners{at, at + 1, at + 1 + columns, at + columns};
      mesh.quads.push_back({int(corners[0]), int(corners[1]), int(corners[2]), int(corners[3])});
      for (const size_t corner : corners) {
        shear[corner] += place.shear[i + j * (columns - 1)];
        ++cells[corner];
      }
    }
  }
  std::string text = "u,v,x,y,z,shear_deg\n";
  for (size_t n = 0; n < net.nodes.size(); ++n) {
    const Eigen::Vector3d& p = net.nodes[n];
    for (const double value : {mesh.rest[n].x(), mesh.rest[n].y(), p.x(), p.y(), p.z()})
      text += exact(value) + ',';
    text += exact(kDegrees * shear[n] / cells[n]) + '\n';
  }
  write_text(folder / "net.csv", text);
  write_vtu(folder / "net.vtu", mesh, place);
}

void write_frames(const std::filesystem::path& folder, const std::string& name, const Mesh& mesh,
                  const std::vector<Snapshot>& frames, const Mold* mold, double thickness) {
  std::vector<PvdEntry> entries;
  for (size_t k = 0; k < frames.size(); ++k) {
    const std::string file = fmt::format("{}_{:03}.vtu", name, k);
    const std::vector<double> gaps = mold ? nodal_gaps(frames[k], *mold, thickness) : std::vector<double>{};
    write_vtu(folder / file, mesh, frames[k], gaps);
    entries.push_back({frames[k].time, file});
  }
  write_pvd(folder / (name + ".pvd"), entries);
}

}  // namespace drapeplan
