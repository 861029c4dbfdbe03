#include "fem/shell/tables.hpp"

#include <cmath>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

// Reissner's factor for a homogeneous section; [Krogh], Eq. (14).
constexpr double kShearCorrection = 5.0 / 6;
constexpr double kTabulatedStrain = 0.02;  // at least; beyond the table the last piece goes on
constexpr double kFibreStep = 4e-5;  // strain per piece: the power law of tension is met to 1e-5 of its end
constexpr double kTabulatedSine = 0.98;  // 78.5 degrees; tau / cos g goes on linearly from there
constexpr int kShearIntervals = 490;

/// Range and pieces of the resampled fibre curve.
struct FibreGrid {
  explicit FibreGrid(const Fabric& fabric) {
    for (const Curve& curve : fabric.compression.curves) lower = std::min(lower, -curve.strain.back());
    for (const Curve& curve : fabric.tension.curves) upper = std::max(upper, curve.strain.back());
    intervals = int(std::lround((upper - lower) / kFibreStep));
  }
  double lower = -kTabulatedStrain, upper = kTabulatedStrain;
  int intervals = 0;
};

/// Nominal stress over nominal strain [-] and rate [1/s].
double fibre_stress(const Fabric& fabric, double strain, double rate) {
  return strain >= 0 ? fabric.tension(strain, rate, fabric.rate_floor)
                     : -fabric.compression(-strain, rate, fabric.rate_floor);
}

/// Conjugate shear stress / cos g over sin g and rate of the angle [rad/s].
double shear_stress(const Fabric& fabric, double sine, double rate) {
  const double angle = std::asin(std::abs(sine));
  const double conjugate = fabric.shear_measure == ShearMeasure::conjugate ? 1 / std::cos(angle) : 1;
  return std::copysign(fabric.shear(angle, rate, fabric.rate_floor) * conjugate, sine);
}

}  // namespace

KernelMaterial kernel_material(const Fabric& fabric, const FemOptions& options) {
  KernelMaterial material;
  material.thickness = fabric.thickness;
  material.transverse = kShearCorrection * fabric.transverse_shear_modulus * fabric.thickness;
  const FibreGrid grid(fabric);
  material.fibre =
      Lookup([&](double e) { return fibre_stress(fabric, e, 0); }, grid.lower, grid.upper, grid.intervals);
  material.shear = Lookup([&](double sine) { return shear_stress(fabric, sine, 0); }, -kTabulatedSine,
                          kTabulatedSine, kShearIntervals);
  material.director_modulus = fabric.compression.slowest().smallest_slope();
  material.hourglass_modulus = options.hourglass * material.director_modulus;
  return material;
}

RateTables rate_tables(const Fabric& fabric) {
  double fastest = 0;
  for (const StressTable* table : {&fabric.tension, &fabric.compression, &fabric.shear}) {
    if (table->rate_dependent()) fastest = std::max(fastest, table->rates.back());
  }
  const FibreGrid grid(fabric);
  RateTables tables;
  tables.fibre = RateLookup([&](double e, double rate) { return fibre_stress(fabric, e, rate); }, grid.lower,
                            grid.upper, grid.intervals, fabric.rate_floor, fastest);
  tables.shear = RateLookup([&](double sine, double rate) { return shear_stress(fabric, sine, rate); },
                            -kTabulatedSine, kTabulatedSine, kShearIntervals, fabric.rate_floor, fastest);
  tables.gain = 1 / (fabric.rate_filter * fabric.rate_floor);
  return tables;
}

ElementGeometry<double> element_geometry(const Mesh& mesh, const std::array<int, 4>& quad) {
  std::array<Eigen::Vector2d, 4> X;
  for (size_t c = 0; c < 4; ++c) X[c] = mesh.rest[size_t(quad[c])];
  const Eigen::Vector2d ac = X[2] - X[0], bd = X[3] - X[1];
  ElementGeometry<double> g{};
  g.area = 0.5 * (ac.x() * bd.y() - ac.y() * bd.x());
  if (!(g.area > 0)) throw WrongInput("shell: an element's area is not positive");
  g.b10 = -bd.y() / (2 * g.area);
  g.b11 = ac.y() / (2 * g.area);
  g.b20 = bd.x() / (2 * g.area);
  g.b21 = -ac.x() / (2 * g.area);
  g.half1 = 0.5 / std::sqrt(2 * (g.b10 * g.b10 + g.b11 * g.b11));
  g.half2 = 0.5 / std::sqrt(2 * (g.b20 * g.b20 + g.b21 * g.b21));
  const Eigen::Vector2d skew = (X[0] - X[1]) + (X[2] - X[3]);  // in this order zero for a rectangle
  g.skew1 = skew.x();
  g.skew2 = skew.y();
  const Eigen::Vector2d r = 0.25 * (ac - bd), s = 0.25 * (ac + bd);
  g.r11 = r.x();
  g.r12 = r.y();
  g.r21 = s.x();
  g.r22 = s.y();
  g.across1 = 0.25 / g.half1;
  g.across2 = 0.25 / g.half2;
  g.shape = g.area * (1 / (g.half1 * g.half1) + 1 / (g.half2 * g.half2)) / 96;
  g.inverse = 1 / (g.r11 * g.r22 - g.r12 * g.r21);
  g.linear_r = s.squaredNorm() * g.inverse * g.inverse / 3;
  g.linear_s = r.squaredNorm() * g.inverse * g.inverse / 3;
  return g;
}

}  // namespace drapeplan
