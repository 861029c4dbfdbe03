#include "planner/characterise/shear.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "mapping/error.hpp"
#include "planner/measured/smooth.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGrid = kDegree;               // of angles: where tables of forces and stresses have points
constexpr double kValidBias = 30 * kDegree;     // of angles from the crosshead (J. Cao and others, 2008)
constexpr double kValidFrame = 35 * kDegree;    // the same
constexpr double kSameRate = 0.1;               // relative: tests whose rates differ by less are averaged

/// One specimen in numbers, whatever test it is from.
struct Specimen {
  ShearForce force;
  std::function<double(double)> rate_at;  ///< rate of the angle at an angle [1/s]
  bool measured_angle = false;
};

/// All specimens of one rate.
struct RateGroup {
  double rate = 0;           ///< at the start [1/s]
  std::vector<double> mean;  ///< force at the points of the grid [N]
  std::function<double(double)> rate_at;
};

/// Points of the grid up to an angle.
std::vector<double> grid_to(double angle) {
  std::vector<double> grid;
  for (int k = 0; k * kGrid <= angle * (1 + 1e-12); ++k) grid.push_back(k * kGrid);
  return grid;
}

/// Rows of a test up to the largest displacement, with angles: those that were measured, or of the crosshead.
Specimen specimen_of(const std::string& file, const TestTable& table, double speed, double first_rate,
                     const std::function<double(double)>& angle_of,
                     const std::function<double(double)>& rate_of) {
  const std::vector<double>& way = table[TestQuantity::displacement];
  const size_t rows = size_t(std::max_element(way.begin(), way.end()) - way.begin()) + 1;
  Specimen one{{file, first_rate, {}, {}}, rate_of, table.has(TestQuantity::angle)};
  std::vector<double> places;
  for (size_t k = 0; k < rows; ++k) {
    const double place = way[k] - way.front();
    const double angle = one.measured_angle
                             ? table[TestQuantity::angle][k] - table[TestQuantity::angle].front()
                             : angle_of(place);
    one.force.angle.push_back(angle);
    one.force.force.push_back(table[TestQuantity::force][k]);
    places.push_back(place);
  }
  if (!one.measured_angle) return one;
  // The rate from the slope of the angle over the crosshead's way, at twenty knots.
  constexpr int kKnots = 20;
  std::vector<double> knots;
  for (int k = 0; k <= kKnots; ++k) knots.push_back(places.back() * k / kKnots);
  const std::vector<double> angles =
      not_decreasing(fit_at_knots(places, one.force.angle, knots, 0), std::vector<double>(knots.size(), 1));
  const MonotoneCubic angle(knots, angles);
  one.rate_at = [angle, knots, angles, speed](double at) {
    return std::max(angle.slope(value_between(angles, knots, at)), 1e-6) * speed;
  };
  return one;
}

/// Mean forces by rate, slowest first, at a common grid; fills specimens, band and ranges of the law.
std::vector<RateGroup> groups_of(std::vector<Specimen> specimens, double valid, ShearLaw& law) {
  std::stable_sort(specimens.begin(), specimens.end(),
                   [](const Specimen& a, const Specimen& b) { return a.force.rate < b.force.rate; });
  law.measured_to = std::numeric_limits<double>::infinity();
  bool all_measured = true;
  for (const Specimen& one : specimens) {
    law.measured_to =
        std::min(law.measured_to, *std::max_element(one.force.angle.begin(), one.force.angle.end()));
    all_measured = all_measured && one.measured_angle;
    law.specimens.push_back(one.force);
  }
  const std::vector<double> grid = grid_to(law.measured_to);
  if (grid.size() < 3)
    throw NotFinished(fmt::format("{}: the fabric is sheared by {:.2g} degrees only", specimens.front().force.name,
                                  law.measured_to / kDegree));
  law.measured_to = grid.back();
  law.valid_to = all_measured ? law.measured_to : std::min(law.measured_to, valid);
  std::vector<RateGroup> groups;
  double missed = 0, whole = 0;
  for (size_t first = 0, last = 0; first < specimens.size(); first = last) {
    std::vector<double> angle, force;
    const double rate = specimens[first].force.rate;
    for (last = first; last < specimens.size() && specimens[last].force.rate <= rate * (1 + kSameRate); ++last) {
      const ShearForce& one = specimens[last].force;
      angle.insert(angle.end(), one.angle.begin(), one.angle.end());
      force.insert(force.end(), one.force.begin(), one.force.end());
    }
    RateGroup group{rate, fit_at_knots(angle, force, grid, 0), specimens[first].rate_at};
    const MonotoneCubic mean(grid, group.mean);
    for (size_t k = 0; k < angle.size(); ++k) {
      if (angle[k] > grid.back()) continue;
      missed += std::pow(force[k] - mean(angle[k]), 2);
      whole += std::pow(mean(angle[k]), 2);
    }
    groups.push_back(std::move(group));
  }
  law.band = whole > 0 ? std::sqrt(missed / whole) : 0;
  return groups;
}

/// Forces at constant rates: of the surface through all groups, over angle and logarithm of the rate.
void read_slices(const std::vector<RateGroup>& groups, ShearLaw& law) {
  const std::vector<double> grid = grid_to(law.measured_to);
  for (const RateGroup& group : groups) law.slices.push_back({"", group.rate, grid, group.mean});
  if (groups.size() == 1) return;
  for (size_t j = 0; j < grid.size(); ++j) {
    std::vector<double> rates, forces;
    for (const RateGroup& group : groups) {
      rates.push_back(std::log(group.rate_at(grid[j])));
      forces.push_back(group.mean[j]);
    }
    const MonotoneCubic over_rate(rates, forces);
    for (ShearForce& slice : law.slices) slice.force[j] = over_rate(std::log(slice.rate));
  }
}

/// Share of the faster of two neighbouring rates in what the law has at a rate, see StressTable.
struct RateShare {
  size_t slower = 0, faster = 0;
  double share = 0;
};

RateShare share_of(const std::vector<RateGroup>& groups, double rate, double floor) {
  size_t k = 0;
  while (k < groups.size() && groups[k].rate < rate) ++k;
  if (k == 0) return {0, 0, 0};
  if (k == groups.size()) return {k - 1, k - 1, 0};
  const auto scale = [&](double r) { return std::log1p(r / floor); };
  const double low = scale(groups[k - 1].rate), high = scale(groups[k].rate);
  return {k - 1, k, (scale(rate) - low) / (high - low)};
}

/// Value of a table of equally spaced points between them.
double on_grid(const std::vector<double>& values, double angle) {
  const double at = angle / kGrid;
  const auto k = std::min(size_t(at), values.size() - 2);
  return values[k] + (at - double(k)) * (values[k + 1] - values[k]);
}

/// Conjugate shear force per length C = F_sh cos(g) [N/m] by rate and angle, from the balance of power of each
/// test, (2 H - 3 W) C(g) + W C(g/2) = (H/W - 1) F (cos(g/2) - sin(g/2)), [Krogh], Eq. (10).
/// By the law: C(g) at the rate of the test at this angle, C(g/2) at half of it, both between the rates of the law;
/// as many equations as rates. Else, as in the article: forces at constant rates, and the same rate for both.
std::vector<std::vector<double>> invert_bias(const ShearLaw& law, const std::vector<RateGroup>& groups,
                                             double height, double width, const ShearOptions& options) {
  const size_t angles = law.slices.front().angle.size();
  const auto n = Eigen::Index(groups.size());
  std::vector<std::vector<double>> c(groups.size(), std::vector<double>(angles, 0.0));
  for (size_t j = 1; j < angles; ++j) {
    const double g = double(j) * kGrid;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index test = 0; test < n; ++test) {
      const auto k = size_t(test);
      const double force = options.by_law ? groups[k].mean[j] : law.slices[k].force[j];
      right[test] = (height / width - 1) * force * (std::cos(g / 2) - std::sin(g / 2));
      const RateShare same{k, k, 0};
      const RateShare whole = options.by_law ? share_of(groups, groups[k].rate_at(g), options.rate_floor) : same;
      const RateShare half =
          options.by_law ? share_of(groups, 0.5 * groups[k].rate_at(g), options.rate_floor) : same;
      const auto each = [](const RateShare& share, const auto& add) {
        add(share.slower, 1 - share.share), add(share.faster, share.share);
      };
      each(whole, [&](size_t rate, double share) {
        matrix(test, Eigen::Index(rate)) += share * (2 * height - 3 * width);
      });
      each(half, [&](size_t rate, double share) {
        if (j == 1)  // in the first piece C(g/2) = C(g) / 2
          matrix(test, Eigen::Index(rate)) += 0.5 * share * width;
        else
          right[test] -= share * width * on_grid(c[rate], g / 2);
      });
    }
    const Eigen::VectorXd solved = matrix.partialPivLu().solve(right);
    for (size_t k = 0; k < groups.size(); ++k) c[k][j] = solved[Eigen::Index(k)];
  }
  return c;
}

/// Points of a curve that are needed: without the others it changes by less than a share of its value.
Curve thinned(const Curve& curve) {
  constexpr double kShare = 0.003;
  Curve thin{{curve.strain.front()}, {curve.stress.front()}};
  size_t last = 0;
  for (size_t k = 1; k < curve.strain.size(); ++k) {
    if (k + 1 < curve.strain.size()) {
      bool straight = true;
      for (size_t m = last + 1; m <= k && straight; ++m) {
        const double t = (curve.strain[m] - curve.strain[last]) / (curve.strain[k + 1] - curve.strain[last]);
        const double line = curve.stress[last] + t * (curve.stress[k + 1] - curve.stress[last]);
        straight = std::abs(line - curve.stress[m]) <= kShare * curve.stress[m];
      }
      if (straight) continue;
    }
    thin.strain.push_back(curve.strain[k]);
    thin.stress.push_back(curve.stress[k]);
    last = k;
  }
  return thin;
}

/// From conjugate forces per length to the law's table; curves that fall are kept as measured.
void finish(const std::vector<std::vector<double>>& c, const std::vector<RateGroup>& groups,
            const ShearOptions& options, ShearLaw& law) {
  const std::vector<double> grid = grid_to(law.measured_to);
  std::vector<std::vector<double>> rising;
  for (const std::vector<double>& one : c) {
    Curve measured{grid, one};
    for (size_t j = 0; j < grid.size(); ++j) {
      measured.stress[j] /= options.thickness;
      if (options.measure == ShearMeasure::force) measured.stress[j] /= std::cos(grid[j]);
    }
    rising.push_back(not_decreasing(measured.stress, std::vector<double>(grid.size(), 1)));
    law.measured.push_back(std::move(measured));
  }
  for (size_t k = 0; k < rising.size(); ++k) {
    for (size_t j = 0; j < grid.size(); ++j) {
      double& stress = rising[k][j];
      stress = j == 0 ? 0 : std::max({stress, rising[k][j - 1], k > 0 ? rising[k - 1][j] : 0});
    }
    law.table.curves.push_back(thinned({grid, rising[k]}));
    if (rising.size() > 1) law.table.rates.push_back(groups[k].rate);
  }
}

}  // namespace

double bias_angle(double displacement, double length) {
  const double cosine = (length + displacement) / (std::numbers::sqrt2 * length);
  return std::numbers::pi / 2 - 2 * std::acos(std::min(cosine, 1.0));
}

double bias_rate(double angle, double length, double speed) {
  return std::numbers::sqrt2 * speed / (length * std::sin(std::numbers::pi / 4 - angle / 2));
}

double bias_force(double whole, double half, double angle, double height, double width) {
  return ((2 * height - 3 * width) * whole + width * half) /
         ((height / width - 1) * (std::cos(angle / 2) - std::sin(angle / 2)));
}

ShearLaw bias_extension_law(const std::vector<StripTest>& tests, const ShearOptions& options) {
  const double height = tests.front().height, width = tests.front().width;
  std::vector<Specimen> specimens;
  for (const StripTest& test : tests) {
    if (test.height != height || test.width != width)
      throw WrongInput(test.file + ": all strips of bias extension must have one size");
    const double length = height - width;
    specimens.push_back(specimen_of(
        test.file, test.table, test.rate, bias_rate(0, length, test.rate),
        [length](double way) { return bias_angle(way, length); },
        [length, speed = test.rate](double angle) { return bias_rate(angle, length, speed); }));
  }
  ShearLaw law;
  const std::vector<RateGroup> groups = groups_of(std::move(specimens), kValidBias, law);
  read_slices(groups, law);
  finish(invert_bias(law, groups, height, width, options), groups, options, law);
  return law;
}

ShearLaw picture_frame_law(const std::vector<FrameTest>& tests, const ShearOptions& options) {
  const double side = tests.front().side, fabric = tests.front().specimen.value_or(side);
  std::vector<Specimen> specimens;
  for (const FrameTest& test : tests) {
    if (test.side != side || test.specimen.value_or(side) != fabric)
      throw WrongInput(test.file + ": all frames and their fabrics must have one size");
    // Half the angle between the bars: cos = (sqrt(2) L + d) / (2 L).
    const auto angle = [side](double way) {
      return std::numbers::pi / 2 -
             2 * std::acos(std::min((std::numbers::sqrt2 * side + way) / (2 * side), 1.0));
    };
    const auto rate = [side, speed = test.rate](double at) {
      return speed / (side * std::sin(std::numbers::pi / 4 - at / 2));
    };
    specimens.push_back(specimen_of(test.file, test.table, test.rate, rate(0), angle, rate));
  }
  ShearLaw law;
  const std::vector<RateGroup> groups = groups_of(std::move(specimens), kValidFrame, law);
  read_slices(groups, law);
  std::vector<std::vector<double>> c;
  for (const ShearForce& slice : law.slices) {
    c.emplace_back();
    for (size_t j = 0; j < slice.angle.size(); ++j)
      c.back().push_back(slice.force[j] * side / (fabric * fabric) *
                         std::sin(std::numbers::pi / 4 - slice.angle[j] / 2));
  }
  finish(c, groups, options, law);
  return law;
}

}  // namespace drapeplan
