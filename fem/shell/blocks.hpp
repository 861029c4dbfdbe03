// Elements in runs as wide as the lanes, and how these read and write the fields of their nodes.
#pragma once

#include <array>
#include <vector>

#include "fem/core/lanes.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/shell/element.hpp"

namespace drapeplan {

/// A run of elements, at most kLanes; idle lanes have the geometry of the last element, and no area.
struct Block {
  std::array<std::array<int, size_t(kLanes)>, 4> node;  ///< by corner and lane
  bool in_row = false;     ///< elements of one row of a grid: nodes of a corner follow each other
  bool rectangle = false;  ///< all elements are, along the fibres
  bool twins = false;      ///< there are triangles
  int used = 0;
  size_t geometry = 0;  ///< among the different ones: in a rectangle few blocks differ
};

/// Adds a row's shares of its elements' lower (or upper) corners to nodes: `own` to node `at` and those that
/// follow, `next` to the nodes after them.
inline void add_row(double* sum, size_t at, const Lanes& own, const Lanes& next) {
  store(load(sum + at) + (own + shifted_up(next)), sum + at);
  sum[at + size_t(kLanes)] += next[size_t(kLanes) - 1];
}

/// A vector field as the corners of blocks see it. In a row, corners 1 and 2 are the next nodes of corners 0
/// and 3, so that lanes load without gathering and sums of neighbours are made before they are stored.
template <class T>
struct Rows {
  template <class Field>
  explicit Rows(Field& field) : part{field.x.data(), field.y.data(), field.z.data()} {}

  [[nodiscard]] Corners<Lanes> in_row(const Block& block) const {
    const auto lower = size_t(block.node[0][0]), upper = size_t(block.node[3][0]);
    return {lanes(lower), lanes(lower + 1), lanes(upper + 1), lanes(upper)};
  }
  [[nodiscard]] Corners<Lanes> anywhere(const Block& block) const {
    Corners<Lanes> out;
    for (size_t c = 0; c < 4; ++c) {
      const auto& node = block.node[c];
      out[c] = {pick(part[0], node), pick(part[1], node), pick(part[2], node)};
    }
    return out;
  }
  [[nodiscard]] Corners<Lanes> corners(const Block& block) const {
    return block.in_row ? in_row(block) : anywhere(block);
  }
  void add_in_row(const Block& block, const Corners<Lanes>& values) const {
    const auto lower = size_t(block.node[0][0]), upper = size_t(block.node[3][0]);
    add_row(part[0], lower, values[0].x, values[1].x);
    add_row(part[1], lower, values[0].y, values[1].y);
    add_row(part[2], lower, values[0].z, values[1].z);
    add_row(part[0], upper, values[3].x, values[2].x);
    add_row(part[1], upper, values[3].y, values[2].y);
    add_row(part[2], upper, values[3].z, values[2].z);
  }
  void add_anywhere(const Block& block, const Corners<Lanes>& values) const {
    for (size_t c = 0; c < 4; ++c) {
      for (size_t l = 0; l < size_t(block.used); ++l) {
        const auto at = size_t(block.node[c][l]);
        part[0][at] += values[c].x[l];
        part[1][at] += values[c].y[l];
        part[2][at] += values[c].z[l];
      }
    }
  }

 private:
  [[nodiscard]] Vec3<Lanes> lanes(size_t at) const {
    return {load(part[0] + at), load(part[1] + at), load(part[2] + at)};
  }
  std::array<T*, 3> part;
};

/// Idle lanes of a row's end work on nodes that do not belong together.
inline void clear_idle(const Block& block, Lanes& value) {
  const Lanes lane([](auto l) { return double(l); });
  std::experimental::where(lane >= Lanes(double(block.used)), value) = Lanes(0.0);
}
inline void clear_idle(const Block& block, Corners<Lanes>& values) {
  for (Vec3<Lanes>& value : values) {
    for (Lanes* part : {&value.x, &value.y, &value.z}) clear_idle(block, *part);
  }
}

/// Cuts a mesh into blocks, in the order of its elements. A block ends where the run of consecutive nodes
/// ends.
/// @param geometry  of each element;  @param geometries  gets the different ones of blocks.
void lay_blocks(const Mesh& mesh, const std::vector<ElementGeometry<double>>& geometry,
                std::vector<Block>& blocks, std::vector<ElementGeometry<Lanes>>& geometries);

}  // namespace drapeplan
