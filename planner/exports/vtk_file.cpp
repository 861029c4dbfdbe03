#include "planner/exports/vtk_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>

#include "planner/base/base64.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

static_assert(std::endian::native == std::endian::little, "the header of the files says LittleEndian");

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

std::string text_of(const std::vector<VtkField>& fields) {
  std::string text;
  for (const VtkField& field : fields) text += data_array<double>(field.name, field.width, field.values);
  return text;
}

std::string text_of(const std::vector<VtkCell>& cells) {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  for (const VtkCell& cell : cells) {
    connectivity.insert(connectivity.end(), cell.points.begin(), cell.points.end());
    offsets.push_back(std::int64_t(connectivity.size()));
    types.push_back(std::uint8_t(cell.kind));
  }
  return data_array<std::int64_t>("connectivity", 1, connectivity) +
         data_array<std::int64_t>("offsets", 1, offsets) + data_array<std::uint8_t>("types", 1, types);
}

void check_fields(const std::vector<VtkField>& fields, size_t count, const char* of) {
  for (const VtkField& field : fields) {
    if (field.width < 1 || field.values.size() != count * size_t(field.width))
      throw std::invalid_argument(fmt::format("write_vtu: {} has {} values of width {} for {} {}", field.name,
                                              field.values.size(), field.width, count, of));
  }
}

void check_cells(const VtkGrid& grid) {
  for (const VtkCell& cell : grid.cells) {
    for (const std::int64_t point : cell.points) {
      if (point < 0 || point >= std::int64_t(grid.points.size()))
        throw std::invalid_argument(
            fmt::format("write_vtu: a cell has the corner {} of {} points", point, grid.points.size()));
    }
  }
}

/// Names and widths of all fields, in their order.
std::string signature(const VtkGrid& grid) {
  std::string text;
  for (const auto* fields : {&grid.point_fields, &grid.cell_fields}) {
    for (const VtkField& field : *fields) text += fmt::format("{} x {}, ", field.name, field.width);
    text += "; ";
  }
  return text;
}

}  // namespace

VtkField vtk_vectors(std::string name, const std::vector<Eigen::Vector3d>& vectors) {
  VtkField field{.name = std::move(name), .values = {}, .width = 3};
  field.values.reserve(3 * vectors.size());
  for (const Eigen::Vector3d& vector : vectors)
    field.values.insert(field.values.end(), {vector.x(), vector.y(), vector.z()});
  return field;
}

void write_vtu(const std::filesystem::path& file, const VtkGrid& grid) {
  check_fields(grid.point_fields, grid.points.size(), "points");
  check_fields(grid.cell_fields, grid.cells.size(), "cells");
  check_cells(grid);
  const VtkField points = vtk_vectors("points", grid.points);
  write_text(file,
             fmt::format("<?xml version=\"1.0\"?>\n"
                         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                         "header_type=\"UInt64\">\n"
                         "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
                         "      <Points>\n{}      </Points>\n"
                         "      <Cells>\n{}      </Cells>\n"
                         "      <PointData>\n{}      </PointData>\n"
                         "      <CellData>\n{}      </CellData>\n"
                         "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n",
                         grid.points.size(), grid.cells.size(), text_of(std::vector{points}),
                         text_of(grid.cells), text_of(grid.point_fields), text_of(grid.cell_fields)));
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

void write_over_time(const std::filesystem::path& folder, const std::string& name,
                     const std::vector<double>& times, const std::function<VtkGrid(size_t)>& grid_of) {
  std::vector<PvdEntry> entries;
  std::string first;
  for (size_t k = 0; k < times.size(); ++k) {
    const VtkGrid grid = grid_of(k);
    const std::string fields = signature(grid);
    if (k == 0) first = fields;
    if (fields != first)
      throw std::invalid_argument(
          fmt::format("write_over_time: {} has the fields {} first and {} later", name, first, fields));
    entries.push_back({times[k], fmt::format("{}_{:03}.vtu", name, k)});
    write_vtu(folder / entries.back().file, grid);
  }
  write_pvd(folder / (name + ".pvd"), entries);
}

void write_still(const std::filesystem::path& folder, const std::string& name, const VtkGrid& grid) {
  write_vtu(folder / (name + ".vtu"), grid);
  write_pvd(folder / (name + ".pvd"), {{0, name + ".vtu"}});
}

}  // namespace drapeplan
