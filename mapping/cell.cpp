#include "mapping/cell.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace drapeplan {
namespace {

constexpr double kStepTolerance = 1e-12;  // last Newton step over the shorter edge
constexpr double kLongestStep = 0.5;      // over the shorter edge: keeps away from the mirrored solution
constexpr int kMaxIterations = 80;
constexpr int kMaxHalvings = 30;
// Below this step over the shorter edge the energy no longer tells better from worse: it is taken as it is.
constexpr double kBlindStep = 1e-7;

// Energy with gradient and Hessian with respect to the free corner's place in space.
struct Energy {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// Adds the free edge of one fibre family, `edge` = p minus a known corner, with the strain |edge| / length
// - 1. The integral of Eq. (3) is taken by the trapezoidal rule, that is, from the strains of the four edges;
// the two known edges add a constant, which is left out. With points inside the element instead, the parallel
// edges of a twisted cell are played off against each other: edges leave their flat length by O(h^2) within a
// row or two beside the generators, and shear there is off by O(h) instead of O(h^2). (Measured on an oblique
// cylinder.)
void add_free_edge(Energy& energy, const Eigen::Vector3d& edge, double length) {
  constexpr double kWeight = 0.5;  // share of the element at this edge
  const double norm = edge.norm();
  const double strain = norm / length - 1;
  const Eigen::Vector3d tangent = edge / norm;
  const Eigen::Matrix3d along = tangent * tangent.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
  energy.value += kWeight * strain * strain / 2;
  energy.gradient += kWeight * strain / length * tangent;
  energy.hessian += kWeight / length * (along / length + strain / norm * across);
}

Energy energy_at(const Cell& cell, const Eigen::Vector3d& p) {
  Energy energy;
  add_free_edge(energy, p - cell.second, cell.first_length);
  add_free_edge(energy, p - cell.first, cell.second_length);
  return energy;
}

// Newton step in (x, y): the chain rule through p = (x, y, f(x, y)). Where the Hessian is not positive
// definite its eigenvalues are shifted (Levenberg).
Eigen::Vector2d newton_step(const Energy& energy, const Jet& f) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << 1, 0, 0, 1, f.zx, f.zy;
  Eigen::Matrix2d second;
  second << f.zxx, f.zxy, f.zxy, f.zyy;
  const Eigen::Vector2d gradient = tangents.transpose() * energy.gradient;
  Eigen::Matrix2d hessian = tangents.transpose() * energy.hessian * tangents + energy.gradient.z() * second;
  const double mean = hessian.trace() / 2;
  const double spread = std::hypot((hessian(0, 0) - hessian(1, 1)) / 2, hessian(0, 1));
  constexpr double kSmallestRatio = 1e-6;  // of smallest to largest eigenvalue
  const double lacking = kSmallestRatio * (std::abs(mean) + spread) - (mean - spread);
  if (lacking > 0) hessian.diagonal().array() += lacking;
  return -hessian.inverse() * gradient;
}

// The parallelogram's corner; drawn back towards the diagonal's middle where the mold ends before it.
Eigen::Vector2d guess(const Mold& mold, const Cell& cell) {
  const Eigen::Vector2d middle = (cell.first + cell.second).head<2>() / 2;
  Eigen::Vector2d at = 2 * middle - cell.base.head<2>();
  for (int k = 0; k < kMaxHalvings && !std::isfinite(mold.height(at.x(), at.y())); ++k) {
    at = (at + middle) / 2;
  }
  return at;
}

}  // namespace

double middle_shear(const Eigen::Vector3d& p00, const Eigen::Vector3d& p10, const Eigen::Vector3d& p01,
                    const Eigen::Vector3d& p11) {
  const Eigen::Vector3d warp = (p10 - p00) + (p11 - p01), weft = (p01 - p00) + (p11 - p10);
  return std::atan2(warp.dot(weft), warp.cross(weft).norm());  // accurate for small shear
}

FreeCorner place_free_corner(const Mold& mold, const Cell& cell) {
  const double size = std::min(cell.first_length, cell.second_length);
  Eigen::Vector2d at = guess(mold, cell);
  FreeCorner corner;
  for (int k = 0; k < kMaxIterations && !corner.converged; ++k) {
    const Jet f = mold.jet(at.x(), at.y());
    const Energy energy = energy_at(cell, {at.x(), at.y(), f.z});
    Eigen::Vector2d step = newton_step(energy, f);
    if (!step.allFinite()) break;
    step *= std::min(1.0, kLongestStep * size / step.norm());
    corner.converged = step.norm() <= kStepTolerance * size;
    for (int h = 0; h < kMaxHalvings && step.norm() > kBlindStep * size; ++h) {
      const Eigen::Vector2d trial = at + step;
      if (energy_at(cell, mold.point(trial.x(), trial.y())).value <= energy.value) break;
      step /= 2;
    }
    at += step;
  }
  corner.point = mold.point(at.x(), at.y());
  corner.converged = corner.converged && corner.point.allFinite();
  return corner;
}

}  // namespace drapeplan
