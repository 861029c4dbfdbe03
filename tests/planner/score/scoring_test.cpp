#include "planner/score/scoring.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kThickness = 0.0003;
constexpr double kSide = 0.2;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Extent kExtent{{-0.5, -0.5}, {0.5, 0.5}};

/// A ply of 200 mm without shear or strain, whose node (u, v) stands at `place(u, v)` on the mid-surface.
template <class Place>
Snapshot snapshot(const Mesh& mesh, Place place) {
  Snapshot end;
  for (const auto& uv : mesh.rest) end.position.push_back(place(uv.x(), uv.y()));
  end.director.assign(mesh.rest.size(), Vector3d::UnitZ());
  end.shear.assign(mesh.quads.size(), 0.0);
  end.warp_strain.assign(mesh.quads.size(), 0.0);
  end.weft_strain.assign(mesh.quads.size(), 0.0);
  return end;
}

Snapshot flat(const Mesh& mesh, const Vector3d& shift) {
  return snapshot(mesh,
                  [&](double u, double v) -> Vector3d { return Vector3d(u, v, 0.5 * kThickness) + shift; });
}

/// Outline of the undeformed ply on the plane z = 0.
std::vector<Vector3d> square(double side = kSide) {
  const double h = 0.5 * side;
  return {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}, {-h, -h, 0}};
}

Score score_on_plane(const Mesh& mesh, const Snapshot& end, const ScoreOptions& options = {}) {
  return score_drape(mesh, end, Mold(PlaneShape{0}, kExtent), square(), kThickness, options, {});
}

TEST(Scoring, PlyOnThePrescribedPlaceScoresZero) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  const Score score = score_on_plane(mesh, flat(mesh, {0, 0, 0}));
  EXPECT_TRUE(score.valid) << score.reason;
  EXPECT_LE(score.max_gap, 1e-15);
  EXPECT_LE(score.max_boundary_offset, 1e-15);
  EXPECT_LE(score.objective, 1e-9);
}

TEST(Scoring, ParallelPlyAboveAPlaneHasItsGapEverywhere) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  const double gap = 0.004;
  const Score score = score_on_plane(mesh, flat(mesh, {0, 0, gap}));
  EXPECT_LE(std::abs(score.max_gap - gap), 1e-12);
  EXPECT_LE(std::abs(score.rms_gap - gap), 1e-12);
  EXPECT_LE(std::abs(score.max_boundary_offset - gap), 1e-12);
  EXPECT_LE(std::abs(score.rms_boundary_offset - gap), 1e-12);
  EXPECT_LE(std::abs(score.wrinkled_area - kSide * kSide), 1e-12);
}

TEST(Scoring, GapIsMeasuredAlongTheNormalOfAnInclinedPlane) {
  const double angle = 0.4, gap = 0.003;
  const Mold mold(PlaneShape{angle}, kExtent);
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.05);
  const Vector3d normal = mold.normal(0, 0);
  const Snapshot end = snapshot(mesh, [&](double u, double v) -> Vector3d {
    return mold.point(u, v) + normal * (gap + 0.5 * kThickness);
  });
  for (const double found : nodal_gaps(end, mold, kThickness)) EXPECT_LE(std::abs(found - gap), 1e-12);
}

TEST(Scoring, PenetrationCountsAsContact) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.05);
  for (const double gap : nodal_gaps(flat(mesh, {0, 0, -0.001}), Mold(PlaneShape{0}, kExtent), kThickness)) {
    EXPECT_EQ(gap, 0.0);
  }
}

TEST(Scoring, RmsOfALinearGapIsItsAreaMean) {
  // Gap rises from 0 to g along u; nodes with quarter areas are the trapezoidal rule: error h^2 / (6 side^2)
  // g^2.
  const double g = 0.01, h = 0.005;
  const Mesh mesh = rectangle_mesh(kSide, kSide, h);
  const Snapshot end = snapshot(mesh, [&](double u, double v) -> Vector3d {
    return Vector3d(u, v, 0.5 * kThickness + g * (u / kSide + 0.5));
  });
  const double mean_square = g * g * (1.0 / 3 + h * h / (6 * kSide * kSide));
  const Score score = score_on_plane(mesh, end);
  EXPECT_LE(std::abs(score.rms_gap - std::sqrt(mean_square)), 1e-9 * g);
  EXPECT_LE(std::abs(score.max_gap - g), 1e-12);
}

TEST(Scoring, ShiftedPlyIsOffByItsShift) {
  // A square shifted by d along u: its corners and two of its sides are d away from the boundary, the other
  // two sides lie on it but for their last d, where the distance rises from 0 to d.
  const double d = 0.01;
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.01);
  const Score score = score_on_plane(mesh, flat(mesh, {d, 0, 0}));
  EXPECT_LE(std::abs(score.max_boundary_offset - d), 1e-12);
  // The side that moves inwards is d away from the old one, but its ends are nearer to the old other sides.
  const double inner = (kSide - 2 * d) * d * d + 2 * d * d * d / 3;
  const double mean_square = (kSide * d * d + inner + 2 * d * d * d / 3) / (4 * kSide);
  EXPECT_LE(std::abs(score.rms_boundary_offset - std::sqrt(mean_square)), 1e-3 * d);
}

TEST(Scoring, BoundaryOffsetLooksBothWays) {
  // A ply inside a boundary with a long spike: every point of the ply's edge is near, the spike's tip is not.
  std::vector<Vector3d> spiked = square();
  spiked.insert(spiked.begin() + 2, {{0.1, -0.001, 0}, {0.15, 0, 0}, {0.1, 0.001, 0}});
  const BoundaryOffset offset = boundary_offset(square(), spiked);
  EXPECT_LE(std::abs(offset.max - 0.05), 1e-12);
  EXPECT_LE((offset.on_boundary - Vector3d(0.15, 0, 0)).norm(), 1e-12);
  EXPECT_LE((offset.on_edge - Vector3d(0.1, 0, 0)).norm(), 1e-9);
  EXPECT_LE(offset.rms, 0.001);
  EXPECT_EQ(boundary_offset(spiked, square()).max, offset.max);
}

TEST(Scoring, SmallerSquareIsOffByItsCornerDistance) {
  const BoundaryOffset offset = boundary_offset(square(0.1), square(0.2));
  EXPECT_LE(std::abs(offset.max - 0.05 * std::numbers::sqrt2),
            1e-12);                               // from the large corner to the small one
  EXPECT_LE(std::abs(offset.rms - 0.05), 1e-12);  // from the small square to the large one
}

TEST(Scoring, BumpOnAPlaneIsAWrinkleEvenWhereFibresAreTaut) {
  // A ridge of 5 mm across the ply, 40 mm wide: above 1 mm where cos^2 > 1/5.
  const double width = 0.04, height = 0.005;
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.0025);
  Snapshot end = snapshot(mesh, [&](double u, double v) {
    const double c = std::abs(u) < 0.5 * width ? std::cos(std::numbers::pi * u / width) : 0.0;
    return Vector3d(u, v, 0.5 * kThickness + height * c * c);
  });
  end.weft_strain.assign(mesh.quads.size(), 0.001);
  const Score score = score_on_plane(mesh, end);
  const double above = 2 * width / std::numbers::pi * std::acos(std::sqrt(0.2));
  EXPECT_LE(std::abs(score.wrinkled_area - above * kSide),
            2 * 0.0025 * kSide);  // one mesh line on either side
  EXPECT_GT(score.wrinkled_area, 0.0);
}

/// A paraboloid z = c/2 (x^2 + y^2): hollow for c > 0.
Mold paraboloid(double cx, double cy) {
  return Mold(PolynomialShape{{{2, 0, 0.5 * cx}, {0, 2, 0.5 * cy}}}, kExtent);
}

Score score_flat_over(const Mold& mold, double warp_strain, double weft_strain) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  Snapshot end = flat(mesh, {0, 0, 0.03});
  end.warp_strain.assign(mesh.quads.size(), warp_strain);
  end.weft_strain.assign(mesh.quads.size(), weft_strain);
  return score_drape(mesh, end, mold, square(), kThickness, {}, {});
}

TEST(Scoring, TautFlatPlyOverABowlIsBridgingNotWrinkled) {
  const Score score = score_flat_over(paraboloid(2, 2), 0.001, 0.001);
  EXPECT_GT(score.max_gap, 0.02);
  EXPECT_EQ(score.wrinkled_area, 0.0);
}

TEST(Scoring, SlackFlatPlyOverABowlIsWrinkled) {
  EXPECT_LE(std::abs(score_flat_over(paraboloid(2, 2), 0, 0).wrinkled_area - kSide * kSide), 1e-12);
  EXPECT_LE(std::abs(score_flat_over(paraboloid(2, 2), -0.001, -0.001).wrinkled_area - kSide * kSide), 1e-12);
}

TEST(Scoring, BridgingNeedsTheTautFibreAcrossTheHollow) {
  EXPECT_EQ(score_flat_over(paraboloid(2, 0), 0.001, 0).wrinkled_area, 0.0);
  EXPECT_GT(score_flat_over(paraboloid(2, 0), 0, 0.001).wrinkled_area, 0.9 * kSide * kSide);
  EXPECT_EQ(score_flat_over(paraboloid(0, 2), 0, 0.001).wrinkled_area, 0.0);
}

TEST(Scoring, BridgingFollowsAPlyThatIsTurned) {
  // The ply's warp runs along y; only y is hollow.
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  Snapshot end = snapshot(mesh, [](double u, double v) { return Vector3d(-v, u, 0.03); });
  end.warp_strain.assign(mesh.quads.size(), 0.001);
  for (const bool bridges : bridging(mesh, end, paraboloid(0, 2))) EXPECT_TRUE(bridges);
  for (const bool bridges : bridging(mesh, end, paraboloid(2, 0))) EXPECT_FALSE(bridges);
}

TEST(Scoring, ShearAndStrainCountOnlyBeyondTheirLimits) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  Snapshot end = flat(mesh, {0, 0, 0});
  end.shear[3] = -30 * std::numbers::pi / 180;
  end.warp_strain[5] = 0.015;
  end.warp_strain[6] = -0.04;  // a fold: reported, not penalised
  EXPECT_LE(score_on_plane(mesh, end).objective, 1e-9);
  end.shear[3] = -40 * std::numbers::pi / 180;
  end.weft_strain[5] = 0.03;
  const Score score = score_on_plane(mesh, end);
  EXPECT_LE(std::abs(score.max_shear_deg - 40), 1e-9);
  EXPECT_LE(std::abs(score.max_fibre_strain - 0.03), 1e-15);
  EXPECT_LE(std::abs(score.max_fibre_compression - 0.04), 1e-15);
  EXPECT_LE(std::abs(score.objective - (5 + 0.5)), 1e-9);
}

TEST(Scoring, ObjectiveIsTheWeightedSumOfPartsOverTheirReferences) {
  Score score;
  score.max_gap = 0.012;
  score.rms_gap = 0.003;
  score.wrinkled_area = 0.0004;
  score.max_boundary_offset = 0.028;
  score.rms_boundary_offset = 0.010;
  score.duration = 10;
  ScoreOptions options;
  options.weight_rms_gap = 2;
  options.weight_duration = 0.1;
  EXPECT_LE(std::abs(objective(score, options, 0.04) - (12 + 2 * 3 + 1 + 14 + 5 + 1)), 1e-12);
  options.weight_max_gap = 0;
  EXPECT_LE(std::abs(objective(score, options, 0.04) - (2 * 3 + 1 + 14 + 5 + 1)), 1e-12);
}

TEST(Scoring, NotFiniteInputIsAFailureWithItsPlace) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  Snapshot end = flat(mesh, {0, 0, 0});
  end.position[7].z() = kNan;
  const Score score = score_on_plane(mesh, end);
  EXPECT_FALSE(score.valid);
  EXPECT_EQ(score.reason, "not finite: position of node 7");
  EXPECT_EQ(score.objective, kFailedObjective);
  EXPECT_EQ(score.max_gap, 0.0);

  end = flat(mesh, {0, 0, 0});
  end.weft_strain[4] = kNan;
  EXPECT_EQ(score_on_plane(mesh, end).reason, "not finite: weft strain of element 4");
  end = flat(mesh, {0, 0, 0});
  const Score force = score_drape(mesh, end, Mold(PlaneShape{0}, kExtent), square(), kThickness, {},
                                  {.max_actuator_force = kNan});
  EXPECT_EQ(force.reason, "not finite: actuator force");
}

TEST(Scoring, MoldThatIsNotDefinedIsAFailure) {
  // Beside a dome and below its equator there is neither a closest point above ground nor a height.
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  const Mold dome(SphereShape{{0, 0, -0.5}, 0.5}, kExtent);
  const Score score = score_drape(mesh, flat(mesh, {3, 0, -0.7}), dome, square(), kThickness, {}, {});
  EXPECT_FALSE(score.valid);
  EXPECT_EQ(score.reason, "the mold is not defined below node 0");
  EXPECT_EQ(score.objective, kFailedObjective);
}

TEST(Scoring, PlyBesideADomeIsValidOrFailsWithAReason) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  const Mold dome(SphereShape{{0, 0, -0.5}, 0.5}, kExtent);
  const Score score = score_drape(mesh, flat(mesh, {3, 0, -0.5}), dome, square(), kThickness, {}, {});
  EXPECT_TRUE(std::isfinite(score.objective));
  EXPECT_TRUE(score.valid == score.reason.empty());
  EXPECT_TRUE(score.valid || score.objective == kFailedObjective);
}

TEST(Scoring, AFailureIsWorseThanAnyValidRun) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.02);
  for (const double height : {0.01, 1.0, 1e6, 1e30}) {
    const Score score = score_on_plane(mesh, flat(mesh, {0, 0, height}));
    EXPECT_TRUE(score.valid) << score.reason;
    EXPECT_LT(score.objective, failed_score("x").objective);
  }
  const Score absurd = score_on_plane(mesh, flat(mesh, {0, 0, 1e200}));
  EXPECT_TRUE(std::isfinite(absurd.objective));
}

TEST(Scoring, SizesThatDifferAreRefused) {
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.05);
  Snapshot end = flat(mesh, {0, 0, 0});
  end.shear.pop_back();
  EXPECT_THROW(score_on_plane(mesh, end), std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
