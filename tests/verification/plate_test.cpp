// Square plates with small deflection.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

struct PlateCase {
  std::string name;
  PlateEdge edge;
  PlateLoad load;
  double published;
};

class Plates : public ::testing::TestWithParam<PlateCase> {};

// Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells: tables 8, 23, 35, 37; they do not depend on
// nu.
INSTANTIATE_TEST_SUITE_P(
    Square, Plates,
    ::testing::Values(PlateCase{"SupportedUniform", PlateEdge::supported, PlateLoad::uniform, 0.00406235},
                      PlateCase{"SupportedCentral", PlateEdge::supported, PlateLoad::central, 0.01160},
                      PlateCase{"ClampedUniform", PlateEdge::clamped, PlateLoad::uniform, 0.00126532},
                      PlateCase{"ClampedCentral", PlateEdge::clamped, PlateLoad::central, 0.00560}),
    [](const auto& instance) { return instance.param.name; });

TEST_P(Plates, DeflectLikeKirchhoffsPlate) {
  const PlateCase& p = GetParam();
  for (const int n : {8, 16}) {
    const double computed = plate_deflection(p.edge, p.load, n, p.published);
    const double error = test::figure(p.name + " plate, " + std::to_string(n) + " x " + std::to_string(n),
                                      computed, p.published);
    EXPECT_LE(error, n == 8 ? 0.03 : 0.01);
  }
}

}  // namespace
}  // namespace drapeplan
