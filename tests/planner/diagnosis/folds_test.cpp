// Plies that lie on the mold as mapped, with one fold each: of what kind it is, who holds it and since when.
#include "planner/diagnosis/folds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/case/file.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

constexpr double kPi = std::numbers::pi;
/// Height over the mold at a place of the flat ply [m].
using Lift = std::function<double(const Eigen::Vector2d&)>;

const DrapeProblem& quick() {
  static const DrapeProblem problem(
      read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", {"fem.mesh_size=10 mm", "fidelities={}"})
          .definition);
  return problem;
}

const Mesh& mesh() {
  return quick().model(kReport).scene().mesh;
}

/// The mapped ply, lifted off the mold along its normal.
Snapshot lifted(const Lift& lift, double time) {
  const Case& definition = quick().definition();
  Snapshot ply;
  ply.time = time;
  for (const Eigen::Vector2d& rest : mesh().rest) {
    const Eigen::Vector3d foot = mapped_point(quick().mapping().net, *definition.mold, rest);
    const Eigen::Vector3d normal = definition.mold->normal(foot.x(), foot.y());
    ply.position.push_back(foot + (0.5 * definition.material.thickness + lift(rest)) * normal);
    ply.director.push_back(normal);
  }
  ply.shear.assign(mesh().quads.size(), 0);
  ply.warp_strain = ply.weft_strain = ply.shear;
  return ply;
}

/// A drape that ends with that lift; before, at 0, 1, ... s, it had the others.
Drape drape(const std::vector<Lift>& lifts) {
  Drape drape;
  for (size_t k = 0; k < lifts.size(); ++k) drape.frames.push_back(lifted(lifts[k], double(k)));
  drape.run.final = drape.frames.back();
  drape.gap =
      nodal_gaps(drape.run.final, *quick().definition().mold, quick().definition().material.thickness);
  drape.score.valid = true;
  return drape;
}

/// A ridge along the weft of this height and width, its crest at u = `at`, |v| < `reach`.
Lift ridge(double height, double at, double width, double reach) {
  return [=](const Eigen::Vector2d& p) {
    const double along = (p.x() - at) / width, across = p.y() / reach;
    return std::abs(along) < 0.5 && std::abs(across) < 1
               ? height * std::cos(kPi * along) * std::pow(std::cos(0.5 * kPi * across), 2)
               : 0.0;
  };
}

Lift plus(const Lift& a, const Lift& b) {
  return [=](const Eigen::Vector2d& p) { return a(p) + b(p); };
}

const Lift kFlat = [](const Eigen::Vector2d&) { return 0.0; };
Lift all(double height) {
  return [=](const Eigen::Vector2d&) { return height; };
}

TEST(Folds, ThereAreNoneOfAPlyOnItsMold) {
  EXPECT_TRUE(folds_of(quick(), drape({all(0.05), kFlat}), kReport).empty());
  Drape failed = drape({kFlat});
  failed.score.valid = false;
  EXPECT_TRUE(folds_of(quick(), failed, kReport).empty());
}

TEST(Folds, SlackRisesBetweenTheGrippersThatLandedTooNear) {
  // Grippers are 100 mm apart: [1, 2] and [2, 2] stand at u = -100 and 0.
  const Lift fold = ridge(0.006, -0.05, 0.06, 0.04);
  const std::vector<Fold> folds = folds_of(quick(), drape({all(0.05), all(0.02), fold, fold}), kReport);
  ASSERT_EQ(folds.size(), 1u);
  const Fold& one = folds[0];
  EXPECT_EQ(one.kind, FoldKind::slack);
  EXPECT_EQ(one.fibre, Fibre::warp);
  EXPECT_NEAR(one.at.x(), -0.05, 0.006);
  EXPECT_NEAR(one.height, 0.006, 0.0005);
  const RigOptions& rig = *quick().definition().grippers;
  EXPECT_EQ(one.grippers, (std::vector<int>{rig.gripper_at({1, 2}), rig.gripper_at({2, 2})}));
  // The length says how high the arch is.
  EXPECT_NEAR(arch_height(one.slack, one.span), one.height, 0.3 * one.height);
  EXPECT_EQ(one.since, 2);
  EXPECT_EQ(one.before, 1);
  EXPECT_EQ(one.down, 2);
  EXPECT_LT(one.pad_gap, 1e-6);
}

TEST(Folds, StallBetweenPlacesThatLayOnTheMoldBeforeTheGrippers) {
  const Lift fold = ridge(0.006, -0.05, 0.06, 0.04);
  // Gripper [1, 2] and its surroundings are up for one more second.
  const Lift late = plus(fold, ridge(0.03, -0.1, 0.03, 0.03));
  const std::vector<Fold> folds = folds_of(quick(), drape({all(0.05), late, fold}), kReport);
  ASSERT_FALSE(folds.empty());
  EXPECT_EQ(folds[0].kind, FoldKind::stall);
  EXPECT_EQ(folds[0].sides_down, 1);
  EXPECT_EQ(folds[0].down, 2);
}

TEST(Folds, APadAboveTheMoldHoldsThePlyUp) {
  const std::vector<Fold> folds = folds_of(
      quick(),
      drape({[](const Eigen::Vector2d& p) { return 0.004 * std::exp(-p.squaredNorm() / 0.03 / 0.03); }}),
      kReport);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].kind, FoldKind::held_up);
  EXPECT_EQ(folds[0].grippers, std::vector<int>{quick().definition().grippers->gripper_at({2, 2})});
  EXPECT_NEAR(folds[0].pad_gap, 0.004, 1e-4);
  EXPECT_TRUE(std::isnan(folds[0].down));
}

TEST(Folds, AnEdgeBetweenGrippersIsUnheld) {
  const std::vector<Fold> folds = folds_of(quick(), drape({[](const Eigen::Vector2d& p) {
                                             return 0.005 * std::exp(-std::pow((p.x() - 0.05) / 0.02, 2)) *
                                                    std::max(0.0, (p.y() - 0.06) / 0.04);
                                           }}),
                                           kReport);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].kind, FoldKind::edge);
}

TEST(Folds, ATautFibreOverAHollowBridgesIt) {
  // Where does the mold hollow out along the warp, away from pads?
  const Mold& mold = *quick().definition().mold;
  const Eigen::Vector2d at(0.05, 0.05);
  const Eigen::Vector3d foot = mapped_point(quick().mapping().net, mold, at),
                        beside = mapped_point(quick().mapping().net, mold, at + Eigen::Vector2d(0.01, 0)),
                        above = mapped_point(quick().mapping().net, mold, at + Eigen::Vector2d(0, 0.01));
  const bool warp = mold.normal_curvature(foot.x(), foot.y(), (beside - foot).head<2>()) > 0.2;
  ASSERT_TRUE(warp || mold.normal_curvature(foot.x(), foot.y(), (above - foot).head<2>()) > 0.2);
  Drape taut = drape(
      {[&](const Eigen::Vector2d& p) { return 0.003 * std::exp(-(p - at).squaredNorm() / 0.02 / 0.02); }});
  (warp ? taut.run.final.warp_strain : taut.run.final.weft_strain).assign(mesh().quads.size(), 1e-3);
  const std::vector<Fold> folds = folds_of(quick(), taut, kReport);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].kind, FoldKind::bridging);
}

TEST(Folds, ShearAroundAPadRaisesItsRim) {
  const Eigen::Vector2d at(0.022, 0.012);
  Drape rim = drape(
      {[&](const Eigen::Vector2d& p) { return 0.003 * std::exp(-(p - at).squaredNorm() / 0.008 / 0.008); }});
  const std::vector<Fold> slack = folds_of(quick(), rim, kReport);
  ASSERT_EQ(slack.size(), 1u);
  EXPECT_EQ(slack[0].kind, FoldKind::slack);
  rim.run.final.shear.assign(mesh().quads.size(), 0.2);
  const std::vector<Fold> folds = folds_of(quick(), rim, kReport);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].kind, FoldKind::pad_rim);
}

}  // namespace
}  // namespace drapeplan
