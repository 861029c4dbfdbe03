#include "fem/shell/blocks.hpp"

#include <algorithm>

namespace drapeplan {
namespace {

/// How many elements from `first` on have consecutive nodes, at most `most`.
size_t run_from(const Mesh& mesh, size_t first, size_t most) {
  const auto& start = mesh.quads[first];
  const auto continues = [&](size_t l) {
    for (size_t c = 0; c < 4; ++c) {
      if (mesh.quads[first + l][c] != start[c] + int(l)) return false;
    }
    return true;
  };
  size_t run = 1;
  while (run < most && continues(run)) ++run;
  return run;
}

/// The block that starts at element `first`.
Block block_from(const Mesh& mesh, size_t first) {
  const auto& start = mesh.quads[first];
  const size_t most = std::min(mesh.quads.size() - first, size_t(kLanes)), run = run_from(mesh, first, most);
  Block block;
  // The end of a row leaves some lanes idle; only a short run takes what follows along, gathered.
  block.in_row = run >= size_t(kLanes) / 2 && start[1] == start[0] + 1 && start[2] == start[3] + 1;
  block.used = int(block.in_row ? run : most);
  for (size_t l = 0; l < size_t(kLanes); ++l) {
    const auto& quad = mesh.quads[first + std::min(l, size_t(block.used) - 1)];
    for (size_t c = 0; c < 4; ++c) {
      block.node[c][l] = quad[c];
      block.twins = block.twins || quad[c] == quad[(c + 1) % 4];
    }
  }
  return block;
}

ElementGeometry<Lanes> geometry_from(const std::vector<ElementGeometry<double>>& of_elements, size_t first,
                                     size_t used) {
  ElementGeometry<Lanes> geometry;
  for (size_t l = 0; l < size_t(kLanes); ++l) {
    ElementGeometry<double> one = of_elements[first + std::min(l, used - 1)];
    if (l >= used) one.area = 0;
    for (size_t k = 0; k < one.parts().size(); ++k) (*geometry.parts()[k])[l] = *one.parts()[k];
  }
  return geometry;
}

/// Place of a geometry among the known ones, which it joins if it is new.
size_t place_among(std::vector<ElementGeometry<Lanes>>& known, ElementGeometry<Lanes>& geometry) {
  const auto same = [&geometry](ElementGeometry<Lanes>& other) {
    for (size_t k = 0; k < geometry.parts().size(); ++k) {
      if (std::experimental::any_of(*geometry.parts()[k] != *other.parts()[k])) return false;
    }
    return true;
  };
  const auto at = std::find_if(known.begin(), known.end(), same);
  const auto place = size_t(at - known.begin());
  if (at == known.end()) known.push_back(geometry);
  return place;
}

}  // namespace

void lay_blocks(const Mesh& mesh, const std::vector<ElementGeometry<double>>& geometry,
                std::vector<Block>& blocks, std::vector<ElementGeometry<Lanes>>& geometries) {
  for (size_t first = 0; first < mesh.quads.size(); first += size_t(blocks.back().used)) {
    Block block = block_from(mesh, first);
    ElementGeometry<Lanes> own = geometry_from(geometry, first, size_t(block.used));
    block.rectangle = own.rectangle();
    block.geometry = place_among(geometries, own);
    blocks.push_back(block);
  }
}

}  // namespace drapeplan
