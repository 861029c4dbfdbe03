#include "planner/characterise/bending.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mapping/error.hpp"
#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

Fabric shipped_fabric() {
  return read_case(DRAPEPLAN_SOURCE_DIR "/cases/cantilever-150.json").definition.material;
}

/// A strip that drops to 95 mm over minutes, as measured by [Krogh].
TipHistory history() {
  TipHistory strip{.length = 0.15, .width = 0.025, .time = {}, .tip = {}};
  for (double t = 0.2; t < 360; t *= 1.25) {
    strip.time.push_back(t);
    strip.tip.push_back(0.095 - 0.045 * std::pow(0.4 / t, 0.5));
  }
  strip.tip.back() = 0.095;
  return strip;
}

TEST(BendingModel, FindsTheFactorOfTheShippedMaterial) {
  const Fabric fabric = shipped_fabric();
  const CompressionLaw law = compression_law(history(), fabric, 9.81, 3, 2);
  ASSERT_EQ(law.factors.size(), 6U);
  // The shipped factor was found by hand, with cases/cantilever-150.json.
  EXPECT_NEAR(law.factors.front(), 0.0945, 0.03 * 0.0945);
  EXPECT_EQ(law.rates.front(), 1e-15);
  for (size_t k = 1; k < law.factors.size(); ++k) {
    EXPECT_GT(law.factors[k], law.factors[k - 1]);
    EXPECT_GT(law.rates[k], law.rates[k - 1]);
    EXPECT_LT(law.times[k], law.times[k - 1]);
  }
  EXPECT_NEAR(law.first_tip, 0.050, 0.001);
  // The isotropic strip with a drop of 95 mm: D = 1.333 N mm, omega_1 = 10.2 1/s.
  EXPECT_NEAR(law.stiffness, 1.333e-3, 0.005e-3);
  EXPECT_NEAR(law.frequency, 10.2, 0.05);
  EXPECT_THROW((void)law.model.scale_of(0.149), NotFinished);
}

}  // namespace
}  // namespace drapeplan
