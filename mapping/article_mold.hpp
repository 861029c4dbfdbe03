// The mold of the article, for shipped scenes and tests.
#pragma once

#include "mapping/mold.hpp"

namespace drapeplan {

/// [Krogh], Eq. (1): a polynomial over 450 mm by 450 mm.
inline Mold article_mold() {
  return Mold(PolynomialShape{{{1, 0, 1.004},
                               {0, 1, 1.089},
                               {2, 0, -3.667},
                               {1, 1, -4.4},
                               {0, 2, -3.75},
                               {3, 0, 3.086},
                               {2, 1, 8.889},
                               {0, 3, 4.321}}},
              {{0, 0}, {0.45, 0.45}});
}

}  // namespace drapeplan
