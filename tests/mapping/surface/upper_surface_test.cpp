#include "mapping/surface/upper_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapping/net.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/mapping/surface/meshes.hpp"

namespace drapeplan {
namespace {

double article(double x, double y) {
  return article_mold().height(x, y);
}

Triangles article_mesh(int n) {
  return triangulated(article, article_mold().extent(), n, n);
}

Mold fitted(const Triangles& mesh) {
  const UpperSurface surface = upper_surface(mesh, {});
  EXPECT_TRUE(surface.faults.empty()) << surface.faults.front();
  return Mold(surface.spline, surface.extent);
}

/// Largest differences between a mold and the article's, over its extent.
struct Differences {
  double height = 0, normal = 0, curvature = 0;
};
Differences from_article(const Mold& mold) {
  const Mold exact = article_mold();
  Differences d;
  for (double x = 0; x <= 0.45; x += 0.009) {
    for (double y = 0; y <= 0.45; y += 0.009) {
      const Jet f = mold.jet(x, y), g = exact.jet(x, y);
      d.height = std::max(d.height, std::abs(f.z - g.z));
      d.normal = std::max(d.normal, (mold.normal(x, y) - exact.normal(x, y)).norm());
      d.curvature =
          std::max({d.curvature, std::abs(f.zxx - g.zxx), std::abs(f.zxy - g.zxy), std::abs(f.zyy - g.zyy)});
    }
  }
  return d;
}

void expect_fault(const UpperSurface& surface, const std::string& part) {
  for (const std::string& fault : surface.faults) {
    if (fault.find(part) != std::string::npos) return;
  }
  FAIL() << "no fault says \"" << part
         << "\": " << (surface.faults.empty() ? "there is none" : surface.faults.front());
}

TEST(UpperSurface, TheArticlesMoldComesBackFromItsTrianglesAndFinerOnesAreNearer) {
  const Differences coarse = from_article(fitted(article_mesh(22))),
                    fine = from_article(fitted(article_mesh(45)));
  EXPECT_LE(coarse.height, 5e-5);
  EXPECT_LE(fine.height, 4e-6);
  EXPECT_LE(fine.normal, 1e-3);
  EXPECT_LE(fine.curvature, 0.3);  // of 10 1/m; largest at the edge of the extent
  EXPECT_GT(std::log2(coarse.height / fine.height), 2);
}

TEST(UpperSurface, WhatTheFitMissesIsStatedAndFarBelowTheFacets) {
  const UpperSurface surface = upper_surface(article_mesh(45), {});
  ASSERT_TRUE(surface.faults.empty());
  EXPECT_TRUE(surface.warnings.empty());
  EXPECT_EQ(surface.vertices.places, 46 * 46);
  EXPECT_GT(surface.facets.places, 2 * 45 * 45);
  EXPECT_LE(surface.vertices.largest, 3e-6);
  EXPECT_GT(surface.vertices.rms, 0);
  // The height of arc of a diagonal of 14 mm with the curvature of the mold, 8 to 10 1/m.
  EXPECT_NEAR(surface.facets.largest, 1.8e-4, 4e-5);
}

TEST(UpperSurface, OfASolidItsUpperSideCounts) {
  const Triangles upper = article_mesh(30);
  const Mold open = fitted(upper), closed = fitted(solid(upper, -0.2));
  for (double x = 0.01; x < 0.45; x += 0.05) EXPECT_NEAR(open.height(x, 0.2), closed.height(x, 0.2), 1e-12);
}

TEST(UpperSurface, APlaneOfTwoTrianglesStaysAPlane) {
  const Mold mold = fitted(triangulated([](double x, double) { return 0.3 * x; }, {{0, 0}, {2, 1}}, 1, 1));
  for (double x = 0; x <= 2; x += 0.25) {
    EXPECT_NEAR(mold.height(x, 0.4), 0.3 * x, 1e-10);
    EXPECT_NEAR(mold.gaussian_curvature(x, 0.4), 0, 1e-8);
  }
}

TEST(UpperSurface, LongTrianglesOfACylinderDoNotBulge) {
  const Mold exact = cylinder({0, 0, 0}, 0, 1.0);
  const Mold mold =
      fitted(triangulated([&](double x, double y) { return exact.height(x, y); }, exact.extent(), 1, 60));
  for (double x = -0.5; x <= 0.5; x += 0.1) {
    for (double y = -0.45; y <= 0.45; y += 0.05) EXPECT_NEAR(mold.height(x, y), exact.height(x, y), 2e-4);
  }
}

/// A flat, a bend of 30 degrees, a slope, a bend back, a flat: as CAD exports it, 12 facets in each bend and
/// one in all that is flat.
TEST(UpperSurface, LongFacetsBesideTightBendsStayFlat) {
  constexpr double kRadius = 0.1, kAngle = std::numbers::pi / 6, kFlat = 0.3;
  constexpr int kBend = 12;
  std::vector<Eigen::Vector2d> profile{{0, 0}};
  for (int k = 0; k <= kBend; ++k) {
    const double a = kAngle * k / kBend;
    profile.emplace_back(kFlat + kRadius * std::sin(a), kRadius * (1 - std::cos(a)));
  }
  const Eigen::Vector2d end = profile.back() + 0.2 * Eigen::Vector2d(std::cos(kAngle), std::sin(kAngle));
  const Eigen::Vector2d centre = end + kRadius * Eigen::Vector2d(std::sin(kAngle), -std::cos(kAngle));
  for (int k = kBend; k >= 0; --k) {
    const double a = kAngle * k / kBend;
    profile.emplace_back(centre.x() - kRadius * std::sin(a), centre.y() + kRadius * std::cos(a));
  }
  profile.emplace_back(centre.x() + kFlat, centre.y() + kRadius);
  Triangles mesh =
      triangulated([](double, double) { return 0.0; }, {{0, 0}, {1, 1}}, int(profile.size()) - 1, 10);
  for (size_t k = 0; k < mesh.vertices.size(); ++k) {
    mesh.vertices[k].x() = profile[k / 11].x();
    mesh.vertices[k].z() = profile[k / 11].y();
  }
  const UpperSurface surface = upper_surface(mesh, {});
  ASSERT_TRUE(surface.faults.empty()) << surface.faults.front();
  EXPECT_LE(surface.vertices.largest, 1e-5);
  EXPECT_LE(surface.facets.largest, 4e-4);
  const Mold mold(surface.spline, surface.extent);
  for (double x = 0; x <= 0.25; x += 0.01) EXPECT_NEAR(mold.height(x, 0.47), 0, 1e-4) << x;
}

TEST(UpperSurface, AHoleIsNamedWithItsPlace) {
  Triangles mesh = article_mesh(45);
  const int at = 2 * (30 * 45 + 15);  // two rectangles from x = 300 mm, y = 150 mm
  mesh.corners.erase(mesh.corners.begin() + at, mesh.corners.begin() + at + 4);
  expect_fault(upper_surface(mesh, {}), "there is no surface at x = 30");
  EXPECT_TRUE(
      upper_surface(mesh, Extent{{0, 0}, {0.25, 0.45}}).faults.empty());  // it lies beside this extent
}

TEST(UpperSurface, AFoldAndAWallAreNamedWithTheirPlaces) {
  Triangles folded = article_mesh(24);
  for (Eigen::Vector3d& vertex : folded.vertices) vertex.x() -= 0.15 * std::sin(14 * vertex.x());
  expect_fault(upper_surface(folded, {}), "surfaces lie above one another at x = ");
  const auto step = [](double x, double) { return x > 0.2001 ? 0.1 : 0; };
  expect_fault(upper_surface(triangulated(step, {{0, 0}, {0.4, 0.4}}, 200, 4), {}),
               "a wall: the surface falls by");
}

TEST(UpperSurface, AnExtentBeyondTheDataNamesBothAndTheUnitThatMayBeWrong) {
  const Extent metres{{0, 0}, {0.45, 0.45}};
  Triangles mesh = article_mesh(20);
  expect_fault(upper_surface(mesh, Extent{{0, 0}, {0.5, 0.45}}),
               "which is not all of the extent, x from 0.0 to 500.0");
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= 1e-3;
  expect_fault(upper_surface(mesh, metres), "with a unit a thousand times as long it would");
}

TEST(UpperSurface, RefusesWhatIsNoSurface) {
  expect_fault(upper_surface({}, {}), "no triangles");
  Triangles mesh = article_mesh(3);
  mesh.vertices[4].z() = std::nan("");
  expect_fault(upper_surface(mesh, {}), "not finite");
  Triangles upright = article_mesh(3);
  for (Eigen::Vector3d& vertex : upright.vertices) vertex.x() = 0.1;
  expect_fault(upper_surface(upright, {}), "covers no area");
}

TEST(UpperSurface, AnEdgeIsAWarningWithItsPlace) {
  const auto roof = [](double x, double) { return -std::abs(x - 0.2); };
  const UpperSurface surface = upper_surface(triangulated(roof, {{0, 0}, {0.41, 0.4}}, 20, 20), {});
  ASSERT_TRUE(surface.faults.empty());
  ASSERT_FALSE(surface.warnings.empty());
  EXPECT_NE(surface.warnings.back().find("an edge there is rounded off"), std::string::npos);
  EXPECT_NEAR(surface.facets.at.x(), 0.2, 0.03);
}

TEST(UpperSurface, APlyIsMappedOntoTrianglesAsOntoThePolynomial) {
  Ply ply;
  ply.width = ply.height = 0.405;
  ply.position = {0.225, 0.225};
  MappingOptions options;
  options.start = ply.position;
  options.cell_size = 0.0135;
  const Net exact = map_ply(article_mold(), ply, options),
            net = map_ply(fitted(article_mesh(45)), ply, options);
  double largest = 0;
  for (size_t k = 0; k < exact.nodes.size(); ++k)
    largest = std::max(largest, (exact.nodes[k] - net.nodes[k]).norm());
  EXPECT_LE(largest, 2e-5);
}

}  // namespace
}  // namespace drapeplan
