// Mold::closest: the foot of the perpendicular by a damped Newton's method.
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "mapping/mold.hpp"

namespace drapeplan {
namespace {

constexpr double kFootTolerance = 1e-13;  // largest last Newton step [m]
constexpr int kMaxIterations = 60;        // Newton needs about 5; the rest is for damped steps
constexpr int kMaxHalvings = 30;
// Below this step [m] the squared distance no longer tells better from worse: the step is taken as it is.
constexpr double kBlindStep = 1e-8;
// Vertical distance times curvature from which the squared distance may have several minima.
constexpr double kFarField = 0.2;

double squared_distance(const Mold& mold, const Eigen::Vector2d& at, const Eigen::Vector3d& p) {
  return (mold.point(at.x(), at.y()) - p).squaredNorm();
}

// The nearest of the vertical projection and rings around it. The foot lies within |vertical distance| of p.
Eigen::Vector2d best_sample(const Mold& mold, const Eigen::Vector3d& p, double reach) {
  constexpr int kRings = 4, kRays = 12;
  Eigen::Vector2d best = p.head<2>();
  double best_value = squared_distance(mold, best, p);
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2 * std::numbers::pi * ray / kRays;
      const Eigen::Vector2d at =
          p.head<2>() + reach * ring / kRings * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const double value = squared_distance(mold, at, p);
      if (value < best_value) {
        best = at;
        best_value = value;
      }
    }
  }
  return best;
}

// Where Newton's method starts: exact for sphere and cylinder, whose field may not exist below p.
Eigen::Vector2d start_of(const Mold& mold, const Eigen::Vector3d& p) {
  if (const auto* sphere = std::get_if<SphereShape>(&mold.shape())) {
    const Eigen::Vector3d ray = p - sphere->centre;
    return ray.z() > 0 ? Eigen::Vector2d((sphere->centre + sphere->radius * ray.normalized()).head<2>())
                       : Eigen::Vector2d(p.head<2>());
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&mold.shape())) {
    const Eigen::Vector2d across(-std::sin(cylinder->azimuth), std::cos(cylinder->azimuth));
    const double offset = across.dot((p - cylinder->centre).head<2>());
    const double rise = p.z() - cylinder->centre.z();
    const double factor = rise > 0 ? cylinder->radius / std::hypot(offset, rise) : 1;
    return p.head<2>() + (factor - 1) * offset * across;
  }
  const Jet f = mold.jet(p.x(), p.y());
  const double vertical = std::abs(p.z() - f.z);
  const double curvature = std::abs(f.zxx) + std::abs(f.zyy) + 2 * std::abs(f.zxy);
  return vertical * curvature > kFarField ? best_sample(mold, p, vertical) : Eigen::Vector2d(p.head<2>());
}

// Newton step of 1/2 |S(x, y) - p|^2; Gauss-Newton where the Hessian is not positive definite.
Eigen::Vector2d newton_step(const Jet& f, const Eigen::Vector2d& at, const Eigen::Vector3d& p) {
  const double dz = f.z - p.z();
  const Eigen::Vector2d gradient(at.x() - p.x() + dz * f.zx, at.y() - p.y() + dz * f.zy);
  Eigen::Matrix2d metric;
  metric << 1 + f.zx * f.zx, f.zx * f.zy, f.zx * f.zy, 1 + f.zy * f.zy;
  Eigen::Matrix2d second;
  second << f.zxx, f.zxy, f.zxy, f.zyy;
  const Eigen::Matrix2d hessian = metric + dz * second;
  const bool convex = hessian(0, 0) > 0 && hessian.determinant() > 0;
  return -(convex ? hessian : metric).inverse() * gradient;
}

}  // namespace

ClosestPoint Mold::closest(const Eigen::Vector3d& p) const {
  Eigen::Vector2d at = start_of(*this, p);
  double value = squared_distance(*this, at, p);
  ClosestPoint result;
  for (int iteration = 0; iteration < kMaxIterations && !result.converged && std::isfinite(value);
       ++iteration) {
    const Eigen::Vector2d step = newton_step(jet(at.x(), at.y()), at, p);
    result.converged = step.norm() <= kFootTolerance;
    double factor = 1;
    double trial = squared_distance(*this, at + step, p);
    for (int k = 0; k < kMaxHalvings && step.norm() > kBlindStep && !(trial <= value); ++k) {
      factor /= 2;
      trial = squared_distance(*this, at + factor * step, p);
    }
    at += factor * step;
    value = trial;
  }
  result.converged = result.converged && std::isfinite(value);
  result.foot = point(at.x(), at.y());
  result.normal = normal(at.x(), at.y());
  result.signed_distance = (p - result.foot).dot(result.normal);
  return result;
}

}  // namespace drapeplan
