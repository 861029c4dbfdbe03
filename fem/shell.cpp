#include "fem/shell.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace drapeplan {
namespace {

constexpr double kShearCorrection = 5.0 / 6;  // Reissner's factor for a homogeneous section; seed, Eq. (14)
constexpr double kTabulatedStrain = 0.02;     // at least; beyond the table the last piece goes on
constexpr double kFibreStep = 4e-5;  // strain per piece: the power law of tension is met to 1e-5 of its end
constexpr double kTabulatedSine = 0.98;  // 78.5 degrees; tau / cos g goes on linearly from there
constexpr int kShearIntervals = 490;

/// A run of kLanes elements; the last one is filled up with copies of its last element that have no area.
struct Block {
  std::array<std::array<int, size_t(kLanes)>, 4> node;  ///< by corner and lane
  bool contiguous = false;  ///< nodes of every corner are consecutive: lanes load and add without gathering
  int used = 0;
  ElementGeometry<Lanes> geometry;
};

KernelMaterial kernel_material(const Fabric& fabric, const FemOptions& options) {
  KernelMaterial material;
  material.thickness = fabric.thickness;
  material.transverse = kShearCorrection * fabric.transverse_shear_modulus * fabric.thickness;
  const auto fibre = [&](double e) { return e >= 0 ? fabric.tension(e) : -fabric.compression(-e); };
  const double lower = -std::max(kTabulatedStrain, fabric.compression.strain.back());
  const double upper = std::max(kTabulatedStrain, fabric.tension.strain.back());
  material.fibre = Lookup(fibre, lower, upper, int(std::lround((upper - lower) / kFibreStep)));
  const auto shear = [&](double sine) {
    const double angle = std::asin(std::abs(sine));
    return std::copysign(fabric.shear(angle) / std::cos(angle), sine);
  };
  material.shear = Lookup(shear, -kTabulatedSine, kTabulatedSine, kShearIntervals);
  material.hourglass_modulus = options.hourglass * fabric.compression.smallest_slope();
  return material;
}

ElementGeometry<double> element_geometry(const Mesh& mesh, const std::array<int, 4>& quad) {
  std::array<Eigen::Vector2d, 4> X;
  for (size_t c = 0; c < 4; ++c) X[c] = mesh.rest[size_t(quad[c])];
  const Eigen::Vector2d ac = X[2] - X[0], bd = X[3] - X[1];
  ElementGeometry<double> g{};
  g.area = 0.5 * (ac.x() * bd.y() - ac.y() * bd.x());
  if (!(g.area > 0)) throw std::invalid_argument("shell: an element's area is not positive");
  g.b10 = -bd.y() / (2 * g.area);
  g.b11 = ac.y() / (2 * g.area);
  g.b20 = bd.x() / (2 * g.area);
  g.b21 = -ac.x() / (2 * g.area);
  g.half1 = 0.5 / std::sqrt(2 * (g.b10 * g.b10 + g.b11 * g.b11));
  g.half2 = 0.5 / std::sqrt(2 * (g.b20 * g.b20 + g.b21 * g.b21));
  const Eigen::Vector2d skew = X[0] - X[1] + X[2] - X[3];
  g.skew1 = skew.x();
  g.skew2 = skew.y();
  const Eigen::Vector2d r = 0.25 * (ac - bd), s = 0.25 * (ac + bd);
  g.r11 = r.x();
  g.r12 = r.y();
  g.r21 = s.x();
  g.r22 = s.y();
  return g;
}

template <int N>
class ShellTerm final : public Shell {
 public:
  ShellTerm(const Mesh& mesh, const Fabric& fabric, const FemOptions& options)
      : mesh_(mesh), material_(kernel_material(fabric, options)), shear_slope_(fabric.shear.largest_slope()) {
    for (const auto& quad : mesh.quads) geometry_.push_back(element_geometry(mesh, quad));
    for (size_t first = 0; first < mesh.quads.size();) first += add_block(first);
  }

  [[nodiscard]] std::string_view name() const override { return "shell"; }

  [[nodiscard]] std::vector<Forces> entries() const override {
    const int n = mesh_.node_count();
    return {{Book::internal, VectorField(n), VectorField(n)}};
  }

  void add_stiffness(NodalStiffness& stiffness) const override;

  // Inlined as a whole: lanes then stay in registers between the steps of the kernel.
  [[gnu::flatten]] void forces(State& state, Forces* entries) const override {
    VectorField& force = entries->force;
    VectorField& moment = entries->moment;
    force.fill(0);
    moment.fill(0);
    Corners<Lanes> x, d, f, m;
    for (const Block& block : blocks_) {
      for (size_t c = 0; c < 4; ++c) {
        x[c] = gather(state.x, block, c);
        d[c] = gather(state.d, block, c);
      }
      shell_forces<N>(block.geometry, material_, x, d, f, m);
      // Corners 0 and 2, then 1 and 3: neighbours in a row share nodes, so their sums are kept apart in time.
      for (const size_t c : {size_t(0), size_t(2), size_t(1), size_t(3)}) {
        scatter(f[c], block, c, force);
        scatter(m[c], block, c, moment);
      }
    }
  }

  [[nodiscard]] ShellEnergy stored_energy(const State& state) const override {
    ShellEnergy sum;
    for (size_t e = 0; e < mesh_.quads.size(); ++e) {
      const ElementEnergy energy =
          shell_energy<N>(geometry_[e], material_, corners(state.x, e), corners(state.d, e));
      sum.fabric += energy.fabric;
      sum.hourglass += energy.hourglass;
    }
    return sum;
  }

  void strains(const State& state, Snapshot& snapshot) const override {
    const size_t count = mesh_.quads.size();
    snapshot.shear.resize(count);
    snapshot.warp_strain.resize(count);
    snapshot.weft_strain.resize(count);
    for (size_t e = 0; e < count; ++e) {
      const auto m = element_motion(geometry_[e], corners(state.x, e), corners(state.d, e));
      const double length1 = std::sqrt(dot(m.a1, m.a1)), length2 = std::sqrt(dot(m.a2, m.a2));
      snapshot.shear[e] = std::asin(std::clamp(dot(m.a1, m.a2) / (length1 * length2), -1.0, 1.0));
      snapshot.warp_strain[e] = length1 - 1;
      snapshot.weft_strain[e] = length2 - 1;
    }
  }

 private:
  size_t add_block(size_t first);

  [[nodiscard]] Corners<double> corners(const VectorField& field, size_t element) const {
    Corners<double> out;
    for (size_t c = 0; c < 4; ++c) {
      const auto node = size_t(mesh_.quads[element][c]);
      out[c] = {field.x[node], field.y[node], field.z[node]};
    }
    return out;
  }

  static Vec3<Lanes> gather(const VectorField& field, const Block& block, size_t corner) {
    if (block.contiguous) return field.lanes(size_t(block.node[corner][0]));
    const auto& node = block.node[corner];
    const auto pick = [&node](const std::vector<double>& values) {
      return Lanes([&](auto l) { return values[size_t(node[size_t(l)])]; });
    };
    return {pick(field.x), pick(field.y), pick(field.z)};
  }

  static void scatter(const Vec3<Lanes>& value, const Block& block, size_t corner, VectorField& sum) {
    if (block.contiguous) {
      const auto at = size_t(block.node[corner][0]);
      sum.set_lanes(at, sum.lanes(at) + value);
      return;
    }
    for (size_t l = 0; l < size_t(block.used); ++l) {
      const auto at = size_t(block.node[corner][l]);
      sum.x[at] += value.x[l];
      sum.y[at] += value.y[l];
      sum.z[at] += value.z[l];
    }
  }

  Mesh mesh_;
  KernelMaterial material_;
  double shear_slope_;  ///< largest d tau / d g [Pa]
  std::vector<ElementGeometry<double>> geometry_;
  std::vector<Block> blocks_;
};

/// Appends the block that starts at element `first`; a block ends where the run of consecutive nodes ends.
template <int N>
size_t ShellTerm<N>::add_block(size_t first) {
  const size_t left = std::min(mesh_.quads.size() - first, size_t(kLanes));
  size_t run = 1;
  const auto continues = [&](size_t l) {
    for (size_t c = 0; c < 4; ++c) {
      if (mesh_.quads[first + l][c] != mesh_.quads[first][c] + int(l)) return false;
    }
    return true;
  };
  while (run < left && continues(run)) ++run;
  // A short run at the end of a row takes what follows along, gathered.
  Block block;
  block.contiguous = run == size_t(kLanes);
  block.used = int(left);
  for (size_t l = 0; l < size_t(kLanes); ++l) {
    const size_t element = first + std::min(l, left - 1);
    const bool ghost = l >= left;
    const ElementGeometry<double>& g = geometry_[element];
    for (size_t c = 0; c < 4; ++c) block.node[c][l] = mesh_.quads[element][c];
    block.geometry.b10[l] = g.b10;
    block.geometry.b11[l] = g.b11;
    block.geometry.b20[l] = g.b20;
    block.geometry.b21[l] = g.b21;
    block.geometry.area[l] = ghost ? 0 : g.area;
    block.geometry.half1[l] = g.half1;
    block.geometry.half2[l] = g.half2;
    block.geometry.skew1[l] = g.skew1;
    block.geometry.skew2[l] = g.skew2;
    block.geometry.r11[l] = g.r11;
    block.geometry.r12[l] = g.r12;
    block.geometry.r21[l] = g.r21;
    block.geometry.r22[l] = g.r22;
  }
  blocks_.push_back(block);
  return left;
}

/// Sums of absolute rows of the rest stiffness. Both fibre families may act fully on the same node, but never
/// in the same pattern: along one wave, sin^2 a cos^2 b + cos^2 a sin^2 b <= 1, whatever the shear angle. So
/// the larger counts.
template <int N>
void ShellTerm<N>::add_stiffness(NodalStiffness& stiffness) const {
  const double t = material_.thickness;
  const double fibre = material_.fibre.largest_slope();
  for (size_t e = 0; e < mesh_.quads.size(); ++e) {
    const ElementGeometry<double>& g = geometry_[e];
    const HourglassStiffness<double> h = hourglass_stiffness(g, material_);
    const std::array<double, 4> b1{std::abs(g.b10), std::abs(g.b11), std::abs(g.b10), std::abs(g.b11)};
    const std::array<double, 4> b2{std::abs(g.b20), std::abs(g.b21), std::abs(g.b20), std::abs(g.b21)};
    const double sum1 = 2 * (b1[0] + b1[1]), sum2 = 2 * (b2[0] + b2[1]);
    const double warp =
        0.25 / std::min(g.half1, g.half2);  // transverse shear per unit of hourglass displacement
    for (size_t c = 0; c < 4; ++c) {
      const auto node = size_t(mesh_.quads[e][c]);
      const double row1 = b1[c] * sum1, row2 = b2[c] * sum2, both = (b1[c] + b2[c]) * (sum1 + sum2);
      const double fibres = g.area * t * fibre * std::max(row1, row2);
      stiffness.translation[node] +=
          fibres + g.area * (t * shear_slope_ * both + material_.transverse * (row1 + row2)) +
          4 * (h.membrane + g.area * material_.transverse / 3 * 2 * warp * warp);
      stiffness.rotation[node] +=
          fibres * t * t / 12 + g.area * material_.transverse * (0.5 + 2.0 / 3) + 4 * h.director;
      stiffness.coupling[node] += fibres * t / 4 + g.area * material_.transverse * (b1[c] + b2[c] + warp);
    }
  }
}

}  // namespace

std::unique_ptr<Shell> make_shell(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  switch (options.section_points) {
    case 1:
      return std::make_unique<ShellTerm<1>>(mesh, fabric, options);
    case 3:
      return std::make_unique<ShellTerm<3>>(mesh, fabric, options);
    case 5:
      return std::make_unique<ShellTerm<5>>(mesh, fabric, options);
    default:
      throw std::invalid_argument("shell: section_points must be 1, 3 or 5");
  }
}

}  // namespace drapeplan
