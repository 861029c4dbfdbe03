#include "planner/score/score_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kThickness = 0.0003;
constexpr double kSide = 0.2;
const Extent kExtent{{-0.5, -0.5}, {0.5, 0.5}};

/// A ply that is sheared, shifted, and stands up from a plane in a wave of 2 mm.
Snapshot crumpled(const Mesh& mesh, double shift = 0.003) {
  Snapshot end;
  for (const auto& uv : mesh.rest) {
    const double lift = 0.002 * std::pow(std::sin(20 * uv.x()) * std::cos(15 * uv.y()), 2);
    end.position.emplace_back(uv.x() + 0.05 * uv.y() + shift, uv.y(), 0.5 * kThickness + lift);
  }
  end.director.assign(mesh.rest.size(), Vector3d::UnitZ());
  end.shear.assign(mesh.quads.size(), 0.05);
  end.warp_strain.assign(mesh.quads.size(), 1e-4);
  end.weft_strain.assign(mesh.quads.size(), -1e-4);
  return end;
}

/// The outline of the flat ply on the plane z = 0, cut as a mapped one is.
std::vector<Vector3d> boundary() {
  std::vector<Vector3d> points;
  const double h = 0.5 * kSide;
  const std::vector<Vector3d> corners{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}, {-h, -h, 0}};
  constexpr int kParts = 40;
  for (size_t c = 0; c + 1 < corners.size(); ++c) {
    for (int k = 0; k < kParts; ++k)
      points.emplace_back(corners[c] + (corners[c + 1] - corners[c]) * (double(k) / kParts));
  }
  points.push_back(corners.back());
  return points;
}

Score score_of(const Mesh& mesh, const Snapshot& end, const Mold& mold, const ScoreOptions& options) {
  return score_drape(mesh, end, mold, boundary(), kThickness, options,
                     {.max_lag = 0.012, .saturated = 1, .duration = 9});
}

Eigen::VectorXd values(const std::vector<float>& fields) {
  return Eigen::Map<const Eigen::VectorXf>(fields.data(), Eigen::Index(fields.size())).cast<double>();
}

TEST(ScoreFields, GiveTheObjectiveOfTheScore) {
  const Mold mold(PlaneShape{0}, kExtent);
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.01);
  const ScoreOptions options;
  const ScoreFields fields(mesh, mold, boundary(), kThickness, options);
  const Snapshot end = crumpled(mesh);
  const Score score = score_of(mesh, end, mold, options);
  ASSERT_TRUE(score.valid) << score.reason;
  const Eigen::VectorXd own = values(fields.measure(mesh, fields.sampling(mesh), end, score));
  ASSERT_EQ(own.size(), fields.size());
  ASSERT_EQ(fields.scale().size(), fields.size());
  // Between the nodes of the outline its distance from the boundary is not looked at.
  EXPECT_NEAR(fields.objective(own), score.objective, 0.01 * score.objective);
}

/// In a bowl a taut fibre bridges: the same gaps count as wrinkles where it is slack.
TEST(ScoreFields, KnowWhatBridges) {
  const Mold bowl(PolynomialShape{{{2, 0, 1.0}, {0, 2, 1.0}}}, kExtent);
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.01);
  ScoreOptions options;
  options.weight_max_boundary_offset = options.weight_rms_boundary_offset = 0;
  const ScoreFields fields(mesh, bowl, boundary(), kThickness, options);
  Snapshot end = crumpled(mesh);
  for (Vector3d& place : end.position) place.z() += bowl.height(place.x(), place.y());
  std::vector<double> objectives;
  for (const double strain : {1e-3, -1e-3}) {
    end.warp_strain.assign(mesh.quads.size(), strain);
    const Score score = score_of(mesh, end, bowl, options);
    ASSERT_TRUE(score.valid) << score.reason;
    const Eigen::VectorXd own = values(fields.measure(mesh, fields.sampling(mesh), end, score));
    EXPECT_NEAR(fields.objective(own), score.objective, 1e-3 * score.objective);
    objectives.push_back(fields.objective(own));
  }
  EXPECT_LT(objectives[0], objectives[1] - 5);
}

TEST(ScoreFields, NearFieldsHaveTheObjectiveThatIsSoughtEverywhere) {
  const Mold mold(PlaneShape{0}, kExtent);
  const Mesh mesh = rectangle_mesh(kSide, kSide, 0.01);
  const ScoreFields fields(mesh, mold, boundary(), kThickness, {});
  const auto at = [&](double shift) {
    const Snapshot end = crumpled(mesh, shift);
    return values(fields.measure(mesh, fields.sampling(mesh), end, score_of(mesh, end, mold, {})));
  };
  const auto near = fields.objective_near(at(0.003));
  for (const double shift : {0.0, 0.002, 0.008, -0.005})
    EXPECT_EQ(near(at(shift)), fields.objective(at(shift)));
}

TEST(ScoreFields, AFinerMeshGivesTheFieldsOfTheReference) {
  const Mold mold(PlaneShape{0}, kExtent);
  const Mesh coarse = rectangle_mesh(kSide, kSide, 0.02), fine = rectangle_mesh(kSide, kSide, 0.005);
  const ScoreFields fields(coarse, mold, boundary(), kThickness, {});
  const Snapshot end = crumpled(coarse), same = crumpled(fine);
  const Score score = score_of(coarse, end, mold, {});
  const Eigen::VectorXd own = values(fields.measure(coarse, fields.sampling(coarse), end, score));
  const Eigen::VectorXd other = values(fields.measure(fine, fields.sampling(fine), same, score));
  // Nodes of the coarse mesh are nodes of the fine one, and the strains are equal everywhere.
  EXPECT_LE((own - other).lpNorm<Eigen::Infinity>(), 1e-7);
}

TEST(ScoreFields, SamplingIsBilinearInAnyMeshOfThePly) {
  const Mold mold(PlaneShape{0}, kExtent);
  const Polygon hexagon{{-0.1, -0.06}, {0.02, -0.1}, {0.1, -0.03}, {0.1, 0.08}, {-0.03, 0.1}, {-0.1, 0.05}};
  const Mesh coarse = outline_mesh(hexagon, 0.02), fine = outline_mesh(hexagon, 0.007);
  const ScoreFields fields(coarse, mold, boundary(), kThickness, {});
  const ScoreFields::Sampling sampling = fields.sampling(fine);
  ASSERT_EQ(sampling.size(), coarse.rest.size());
  for (size_t k = 0; k < sampling.size(); ++k) {
    const auto& [node, weight] = sampling[k];
    EXPECT_NEAR(weight.sum(), 1, 1e-12);
    EXPECT_GE(weight.minCoeff(), -1e-12);
    Eigen::Vector2d place(0, 0);
    for (int c = 0; c < 4; ++c) place += weight[c] * fine.rest[size_t(node[size_t(c)])];
    EXPECT_LE((place - coarse.rest[k]).norm(), 1e-4) << coarse.rest[k].transpose();
  }
}

}  // namespace
}  // namespace drapeplan
