// Fibre inertia: the filter against dense matrices, and what passes it.
#include "fem/terms/fibre_inertia.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <map>

#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

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
}  // namespace
}  // namespace drapeplan
