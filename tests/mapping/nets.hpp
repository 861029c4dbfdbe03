// Nets and plies that several tests share.
#pragma once

#include "mapping/net.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {

/// The 405 mm ply on the article's mold.
inline Net article_net(Generators generators, double cell_size = 0.005) {
  return map_ply(article_mold(), {0.405, 0.405, {0.225, 0.225}, 0},
                 {generators, {0.225, 0.225}, {0, 0}, cell_size});
}

inline Ply l_shaped_ply() {
  Ply ply{0, 0, {0, 0}, 0};
  ply.outline = {{-0.1, -0.1}, {-0.1, 0.2}, {0, 0.2}, {0, 0}, {0.15, 0}, {0.15, -0.1}};  // clockwise
  return ply;
}

}  // namespace drapeplan
