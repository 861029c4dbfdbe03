// Mass on the stretch of fibres: the filter against dense matrices, what passes it, and drapes with it.
#include "fem/terms/fibre_inertia.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <filesystem>
#include <map>

#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::get;
using test::put;

constexpr double kStretch = 2e4;    // [N/m]
constexpr double kRate = 4e4;       // [1/s]: with nodes of 30 mg, added masses of some 10 mg
constexpr double kNodeMass = 3e-5;  // [kg]
constexpr double kRoundOff = 1e-13;

/// A ply whose nodes have masses of their own, and mass on its fibres.
struct Ply {
  Mesh mesh;
  std::vector<char> with_fibre_inertia;
  std::vector<double> mass = std::vector<double>(size_t(mesh.node_count()));  ///< 0: held [kg]
  std::vector<std::vector<int>> tied{};
  State state{};

  Ply(Mesh from, std::vector<char> elements)
      : mesh(std::move(from)), with_fibre_inertia(std::move(elements)) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.5, 1.5);
    for (double& m : mass) m = kNodeMass * unit(random);
    const auto count = size_t(mesh.node_count());
    state.position = state.director = VectorField(mesh.node_count());
    for (size_t n = 0; n < count; ++n) put(state.position, n, {mesh.rest[n].x(), mesh.rest[n].y(), 0});
    state.edges.fill(VectorField(mesh.node_count()));
  }

  /// Moves the nodes off the plane and within it.
  Ply& crumple(double size) {
    test::disturb(state, mesh.node_count(), size, 0);
    return *this;
  }
  [[nodiscard]] Eigen::Index size() const { return 3 * Eigen::Index(mesh.node_count()); }
  [[nodiscard]] FibreInertia inertia() const {
    std::vector<double> mobility(padded(mesh.node_count()), 0.0);
    for (size_t n = 0; n < mass.size(); ++n) mobility[n] = mass[n] > 0 ? 1 / mass[n] : 0;
    return {mesh, with_fibre_inertia, kStretch, kRate, std::move(mobility), tied};
  }
  /// 1 / mass of every component; 0 where a node is held, by a pad too.
  [[nodiscard]] VectorXd mobility() const {
    VectorXd w(size());
    for (size_t n = 0; n < mass.size(); ++n)
      w.segment<3>(3 * Eigen::Index(n)).setConstant(mass[n] > 0 ? 1 / mass[n] : 0);
    for (size_t pad = 0; pad < tied.size(); ++pad) {
      for (const int n : tied[pad]) {
        if (!state.pads[pad].released) w.segment<3>(3 * n).setZero();
      }
    }
    return w;
  }
};

VectorXd filtered(const FibreInertia& inertia, const State& state, FibreInertiaScratch& scratch,
                  const VectorXd& force) {
  const auto count = int(force.size() / 3);
  VectorField field(count);
  for (int n = 0; n < count; ++n) put(field, size_t(n), force.segment<3>(3 * n));
  inertia.filter(state, scratch, field);
  VectorXd out(force.size());
  for (int n = 0; n < count; ++n) out.segment<3>(3 * n) = get(field, size_t(n));
  return out;
}

/// The filter as a matrix, column by column.
MatrixXd matrix_of(Ply& ply) {
  const FibreInertia inertia = ply.inertia();
  inertia.take_directions(ply.state);
  FibreInertiaScratch scratch = inertia.scratch();
  MatrixXd q(ply.size(), ply.size());
  for (Eigen::Index k = 0; k < ply.size(); ++k)
    q.col(k) = filtered(inertia, ply.state, scratch, VectorXd::Unit(ply.size(), k));
  return q;
}

/// One fibre's edges as rows n (delta_2 - delta_1), and their masses.
struct Edges {
  MatrixXd rows;
  VectorXd mass;
};

/// Half of an element's stretch / rate^2 times width over length for each of its two edges along a fibre.
Edges edges_of(const Ply& ply, int along) {
  std::map<std::pair<int, int>, double> masses;
  for (size_t e = 0; e < ply.mesh.quads.size(); ++e) {
    if (!ply.with_fibre_inertia[e]) continue;
    const auto& quad = ply.mesh.quads[e];
    double length[2] = {0, 0};
    for (size_t c = 0; c < 2; ++c) {
      const Eigen::Vector2d side = ply.mesh.rest[size_t(quad[c + 1])] - ply.mesh.rest[size_t(quad[c])];
      length[std::abs(side.x()) > std::abs(side.y()) ? 0 : 1] = side.norm();
    }
    for (size_t c = 0; c < 4; ++c) {
      const int a = quad[c], b = quad[(c + 1) % 4];
      const Eigen::Vector2d side = ply.mesh.rest[size_t(b)] - ply.mesh.rest[size_t(a)];
      if ((std::abs(side.x()) > std::abs(side.y()) ? 0 : 1) != along) continue;
      masses[std::minmax(a, b)] += 0.5 * kStretch / (kRate * kRate) * length[1 - along] / length[along];
    }
  }
  Edges edges{MatrixXd::Zero(Eigen::Index(masses.size()), ply.size()), VectorXd(masses.size())};
  Eigen::Index row = 0;
  for (const auto& [nodes, mass] : masses) {
    const Eigen::Vector3d n =
        (get(ply.state.position, size_t(nodes.second)) - get(ply.state.position, size_t(nodes.first)))
            .normalized();
    edges.rows.row(row).segment<3>(3 * nodes.first) = -n;
    edges.rows.row(row).segment<3>(3 * nodes.second) = n;
    edges.mass[row++] = mass;
  }
  return edges;
}

/// I - B^T (1 / mu + B W B^T)^-1 B W, for a share of the masses.
MatrixXd dense_pass(const Ply& ply, int along, double share) {
  const Edges edges = edges_of(ply, along);
  const MatrixXd bw = edges.rows * ply.mobility().asDiagonal();
  MatrixXd system = bw * edges.rows.transpose();
  system.diagonal() += (share * edges.mass).cwiseInverse();
  return MatrixXd::Identity(ply.size(), ply.size()) - edges.rows.transpose() * system.ldlt().solve(bw);
}

/// A share of warp, weft, the same share of warp.
MatrixXd dense_filter(const Ply& ply) {
  constexpr double kWarpShare = 0.25;
  const MatrixXd warp = dense_pass(ply, 0, kWarpShare);
  return warp * dense_pass(ply, 1, 1) * warp;
}

void expect_equal(const MatrixXd& got, const MatrixXd& want, double tolerance = kRoundOff) {
  const double error = (got - want).cwiseAbs().maxCoeff();
  EXPECT_TRUE(error <= tolerance * want.cwiseAbs().maxCoeff()) << error;
}

std::vector<char> all_of(const Mesh& mesh) {
  return std::vector<char>(mesh.quads.size(), 1);
}

/// More than eight lines along the weft: they do not all go side by side.
Ply rectangle() {
  Mesh mesh = rectangle_mesh(0.11, 0.04, 0.01);
  std::vector<char> with_fibre_inertia = all_of(mesh);
  return Ply(std::move(mesh), std::move(with_fibre_inertia)).crumple(0.002);
}

/// An L with an oblique edge: lines of different lengths, some in two pieces; triangles and moved nodes at
/// the edge bear nothing.
Ply outline() {
  const Polygon shape{{-0.1, -0.07}, {0.1, -0.07}, {0.1, -0.02}, {0.02, 0.01}, {0.02, 0.07}, {-0.1, 0.07}};
  Mesh mesh = outline_mesh(shape, 0.01);
  std::vector<char> with_fibre_inertia = make_shell(mesh, test::woven_fabric(), {})->with_fibre_inertia();
  return Ply(std::move(mesh), std::move(with_fibre_inertia)).crumple(0.001);
}

/// Leaves out elements: holes cut lines into pieces.
Ply perforated() {
  Ply ply = rectangle();
  for (size_t e = 0; e < ply.with_fibre_inertia.size(); ++e)
    ply.with_fibre_inertia[e] = e % 5 != 1 && e % 7 != 2;
  return ply;
}

/// All nodes have the acceleration that the function gives for their place.
template <class F>
VectorXd force_of(const Ply& ply, const F& acceleration) {
  VectorXd force(ply.size());
  for (size_t n = 0; n < ply.mass.size(); ++n)
    force.segment<3>(3 * Eigen::Index(n)) = ply.mass[n] * acceleration(get(ply.state.position, n));
  return force;
}

VectorXd random_force(const Ply& ply) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  return VectorXd::NullaryExpr(ply.size(), [&]() { return unit(random); });
}

VectorXd filtered(Ply& ply, const VectorXd& force) {
  const FibreInertia inertia = ply.inertia();
  inertia.take_directions(ply.state);
  FibreInertiaScratch scratch = inertia.scratch();
  return filtered(inertia, ply.state, scratch, force);
}

TEST(FibreInertia, IsTheDenseProductOfItsPasses) {
  for (Ply ply : {rectangle(), perforated(), outline()}) {
    const MatrixXd want = dense_filter(ply);
    EXPECT_GE((want - MatrixXd::Identity(ply.size(), ply.size())).cwiseAbs().maxCoeff(), 0.1);
    expect_equal(matrix_of(ply), want);
  }
}

TEST(FibreInertia, HoldsClampedNodesAndThoseUnderAPadUntilItIsReleased) {
  Ply ply = rectangle();
  ply.mass[0] = ply.mass[17] = 0;
  ply.tied = {{26, 27, 28, 38, 39, 40}, {31, 32}};
  ply.state.pads.resize(2);
  const FibreInertia inertia = ply.inertia();
  inertia.take_directions(ply.state);
  FibreInertiaScratch scratch = inertia.scratch();
  const VectorXd force = random_force(ply);
  VectorXd before = force;
  for (const size_t released : {2, 0, 1}) {  // the last one leaves nobody
    if (released < 2) ply.state.pads[released].released = true;
    const VectorXd got = filtered(inertia, ply.state, scratch, force);
    expect_equal(got, dense_filter(ply) * force);
    EXPECT_GE((got - before).cwiseAbs().maxCoeff(), 0.01);
    before = got;
  }
}

TEST(FibreInertia, LetsRigidAndShearingAccelerationsPass) {
  for (Ply ply : {rectangle(), perforated(), outline()}) {
    const Eigen::Vector3d fall(1, -2, -9.81), spin(3, -1, 2);
    const VectorXd falling = force_of(ply, [&](const auto&) { return fall; });
    expect_equal(filtered(ply, falling), falling, 1e-12);
    const VectorXd turning = force_of(ply, [&](const Eigen::Vector3d& x) { return spin.cross(x).eval(); });
    expect_equal(filtered(ply, turning), turning, 1e-12);
  }
  Ply flat(rectangle_mesh(0.11, 0.04, 0.01), all_of(rectangle_mesh(0.11, 0.04, 0.01)));
  const VectorXd shearing = force_of(flat, [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(std::sin(200 * x.y()), x.x() * x.x(), 0);
  });
  expect_equal(filtered(flat, shearing), shearing, 1e-12);
}

TEST(FibreInertia, KeepsMomentumAndAngularMomentum) {
  for (Ply ply : {rectangle(), perforated(), outline()}) {
    const VectorXd force = random_force(ply), change = filtered(ply, force) - force;
    EXPECT_GE(change.cwiseAbs().maxCoeff(), 0.1);
    Eigen::Vector3d sum(0, 0, 0), turn(0, 0, 0);
    for (size_t n = 0; n < ply.mass.size(); ++n) {
      const Eigen::Vector3d by = change.segment<3>(3 * Eigen::Index(n));
      sum += by;
      turn += get(ply.state.position, n).cross(by);
    }
    EXPECT_LE(sum.norm(), 1e-13 * change.norm());
    EXPECT_LE(turn.norm(), 1e-14 * change.norm());  // arms of some cm
  }
}

TEST(FibreInertia, LetsForcesAcrossTheFibresPass) {
  Ply flat(rectangle_mesh(0.11, 0.04, 0.01), all_of(rectangle_mesh(0.11, 0.04, 0.01)));
  VectorXd force = random_force(flat);
  for (Eigen::Index n = 0; n < force.size() / 3; ++n) force.segment<2>(3 * n).setZero();
  EXPECT_EQ(filtered(flat, force), force);  // to the bit
}

// Accelerations W Q f: the inverse of a mass matrix, and that of more mass than the nodes have.
TEST(FibreInertia, IsASymmetricPositiveDefiniteMassAboveThatOfTheNodes) {
  for (Ply ply : {rectangle(), perforated(), outline()}) {
    const VectorXd root = ply.mobility().cwiseSqrt();
    // In coordinates scaled by the root of mass: between 0 and the identity.
    const MatrixXd inverse = root.asDiagonal() * matrix_of(ply) * root.cwiseInverse().asDiagonal();
    EXPECT_LE((inverse - inverse.transpose()).cwiseAbs().maxCoeff(), kRoundOff);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(inverse, Eigen::EigenvaluesOnly);
    EXPECT_GE(spectrum.eigenvalues().minCoeff(), 1e-3);
    EXPECT_LE(spectrum.eigenvalues().minCoeff(), 0.9);
    EXPECT_LE(spectrum.eigenvalues().maxCoeff(), 1 + 1e-12);
  }
}

TEST(FibreInertia, IsBorneByRectanglesAlongTheFibresOnly) {
  const Ply ply = outline();
  size_t others = 0;
  for (size_t e = 0; e < ply.with_fibre_inertia.size(); ++e) {
    if (!ply.with_fibre_inertia[e]) ++others;
    const auto& quad = ply.mesh.quads[e];
    for (size_t c = 0; c < 4 && ply.with_fibre_inertia[e]; ++c) {
      const Eigen::Vector2d side = ply.mesh.rest[size_t(quad[(c + 1) % 4])] - ply.mesh.rest[size_t(quad[c])];
      EXPECT_LE(side.cwiseAbs().minCoeff(), 1e-9 * side.norm()) << e;
      EXPECT_GT(side.norm(), 0) << e;
    }
  }
  EXPECT_GE(others, 5U);
  EXPECT_GE(ply.with_fibre_inertia.size() - others, 30U);
}

/// 3x3 grippers with interlinks over the middle of the article's mold, the middle one fixed, with friction.
/// Masses and time are scaled as in the shipped cases.
Scene drape(double fibre_mass) {
  Scene scene = test::middle_drape(0.205, 0.017);
  scene.options.mass_scaling = 20;
  scene.options.time_scaling = 4;
  scene.options.fibre_mass_scaling = fibre_mass;
  return scene;
}
Schedule drop(const Scene& scene) {
  return test::drop(scene, {.above = 2, .touch = 4, .end = 5});
}
constexpr double kRelease = 4.2;  // [s]
/// A pad in the corner lets go when all lie on the mold.
Schedule drop_and_release(const Scene& scene) {
  Schedule schedule = drop(scene);
  schedule.release.assign(schedule.paths.size(), std::nullopt);
  schedule.release.back() = kRelease;
  return schedule;
}

TEST(FibreInertia, GoesOnWithTheSameBitsThroughAFile) {
  const Scene scene = drape(4);
  const Schedule schedule = drop_and_release(scene);
  const RunResult whole = simulate(Model(scene), {.schedule = &schedule});
  ASSERT_EQ(whole.summary.status, RunStatus::done) << whole.summary.message;
  const fs::path file =
      fs::path(testing::TempDir()) / ("fibre_inertia_test_" + std::to_string(::getpid()) + ".state");
  std::optional<State> from;
  for (const double pause : {0.51, 3.3, 4.6}) {
    const Model model(scene);
    const RunResult part =
        simulate(model, {.schedule = &schedule, .from = from ? &*from : nullptr, .pause = pause});
    ASSERT_EQ(part.summary.status, RunStatus::paused) << part.summary.message;
    EXPECT_NE(part.state.step % scene.options.step_interval, 0);  // directions are not taken anew at once
    save_state(file, model, part.state, &schedule);
    StateReading reading = load_state(file, Model(scene), &schedule);
    ASSERT_TRUE(reading.value) << reading.error;
    EXPECT_FALSE(load_state(file, Model(drape(3)), &schedule).value);
    from = std::move(reading.value);
  }
  fs::remove(file);
  const RunResult parts = simulate(Model(scene), {.schedule = &schedule, .from = &*from});
  EXPECT_EQ(whole.summary.state_hash, parts.summary.state_hash);
  EXPECT_EQ(whole.summary.steps, parts.summary.steps);
  EXPECT_EQ(whole.summary.energy.balance_error, parts.summary.energy.balance_error);
  EXPECT_EQ(whole.state.work, parts.state.work);
}

TEST(FibreInertia, KeepsItsBooksAndAddsNextToNoWork) {
  const Scene scene = drape(4);
  const Schedule schedule = drop(scene);
  const Model model(scene);
  const double first = 0.1, between = 0.1;
  double largest = 0;
  RunResult run = simulate(model, {.schedule = &schedule, .pause = first});
  for (double pause = first + between; run.summary.status == RunStatus::paused; pause += between) {
    largest = std::max(largest, std::abs(run.state.work[size_t(Book::fibre_inertia)]));
    const State from = run.state;
    run = simulate(model, {.schedule = &schedule, .from = &from, .pause = pause});
  }
  ASSERT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  std::printf("balance %.1e; work of added mass %.1e of the largest energy, at the end %.1e\n",
              run.summary.energy.balance_error, largest / run.state.record.energy,
              run.state.work[size_t(Book::fibre_inertia)] / run.state.record.energy);
  EXPECT_LE(run.summary.energy.balance_error, 1e-8);
  EXPECT_GT(largest, 0);
  EXPECT_LE(largest, 0.01 * run.state.record.energy);
}

// Light nodes that a pad has let go must not feel edges as the pad did: with the filter of the pad for one
// step, that step alone gave a tenth of all energy.
TEST(FibreInertia, GivesNoEnergyWhenAPadLetsGo) {
  const Scene scene = drape(4);
  const Schedule schedule = drop_and_release(scene);
  const RunResult run = simulate(Model(scene), {.schedule = &schedule, .pause = kRelease + 0.1});
  ASSERT_EQ(run.summary.status, RunStatus::paused) << run.summary.message;
  ASSERT_TRUE(run.state.pads.back().released);
  const double added = run.state.work[size_t(Book::fibre_inertia)] / run.state.record.energy;
  std::printf("work of added mass after the release: %.1e of the largest energy\n", added);
  EXPECT_LE(added, 0.01);
  EXPECT_GE(added, -0.03);  // the nodes spring off: mass on their edges takes its share
  EXPECT_LE(run.summary.energy.balance_error, 1e-8);
}

TEST(FibreInertia, MakesFewerStepsAndTheSameDrape) {
  RunResult runs[2];
  for (const int k : {0, 1}) {
    const Scene scene = drape(k == 0 ? 1 : 4);
    const Schedule schedule = drop(scene);
    runs[k] = simulate(Model(scene), {.schedule = &schedule});
    ASSERT_EQ(runs[k].summary.status, RunStatus::done) << runs[k].summary.message;
  }
  double apart = 0;
  for (size_t n = 0; n < runs[0].final.position.size(); ++n)
    apart = std::max(apart, (runs[0].final.position[n] - runs[1].final.position[n]).norm());
  const double fewer = double(runs[0].summary.steps) / double(runs[1].summary.steps);
  std::printf("%.2f times fewer steps, %.3f mm apart\n", fewer, 1e3 * apart);
  EXPECT_GE(fewer, 2.2);    // 4 over what the estimate for the state gains on the steepest slopes
  EXPECT_LE(apart, 0.002);  // a move of the start by 1e-12 m does up to 0.5 mm: tests/bench/fem.md
}

// Two by two light grippers hold nothing but each other: what is not symmetric about the mass of edges at
// pads feeds the motion there once they touch. That must not pass for a result.
TEST(FibreInertia, IsBlamedWhereItGivesEnergy) {
  Scene scene = test::corner_drape(0.02);
  scene.options.fibre_mass_scaling = 4;
  const Schedule schedule = test::drop(scene, {.above = 2, .touch = 4, .end = 5});
  const RunResult run = simulate(Model(scene), {.schedule = &schedule});
  EXPECT_EQ(run.summary.status, RunStatus::diverged);
  EXPECT_NE(run.summary.message.find("lower fibre_mass_scaling"), std::string::npos) << run.summary.message;
}

TEST(FibreInertia, PlaysAStepThatIsNotAboveTheTrueOne) {
  const Scene scene = drape(4);
  const Schedule schedule = drop(scene);
  const Model model(scene);
  for (const double pause : {1e-3, 1.0, 3.0, 3.9, 4.5, 0.0}) {
    const RunResult run = simulate(model, {.schedule = &schedule, .pause = pause});
    ASSERT_NE(run.summary.status, RunStatus::diverged) << run.summary.message;
    StepScratch scratch(model);
    State state = run.state;
    model.fibre_inertia()->take_directions(state);  // as choose_step does
    const double estimate = stable_step(model, state, scratch), truth = true_stable_step(model, state);
    std::printf("at %.2f s: estimate %.3f us, true %.3f us, ratio %.3f\n", run.final.time, 1e6 * estimate,
                1e6 * truth, estimate / truth);
    EXPECT_LE(estimate, 1.001 * truth);
    EXPECT_GE(estimate, 0.4 * truth);
  }
}

std::string refusal(const Scene& scene) {
  try {
    const Model model(scene);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "none";
}

TEST(FibreInertia, IsRefusedWithoutAStepThatFollowsTheStateOrWithoutRectangles) {
  Scene scene = drape(4);
  EXPECT_EQ(refusal(scene), "none");
  scene.options.step_interval = 0;
  EXPECT_NE(refusal(scene).find("step_interval above 0"), std::string::npos) << refusal(scene);
  scene = Scene();
  scene.mesh = test::distorted_mesh(0.02, 0.02, 0.01, 0.2);  // of its four elements all share the moved node
  scene.fabric = test::woven_fabric();
  scene.options.fibre_mass_scaling = 4;
  EXPECT_NE(refusal(scene).find("rectangles along the fibres"), std::string::npos) << refusal(scene);
  scene.options.fibre_mass_scaling = 1;
  EXPECT_EQ(refusal(scene), "none");
}

}  // namespace
}  // namespace drapeplan
