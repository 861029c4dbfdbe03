// The shell term of one choice of section points, points across each fibre, and rates.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "fem/law/rates.hpp"
#include "fem/shell/blocks.hpp"
#include "fem/shell/bounds.hpp"
#include "fem/shell/shell.hpp"
#include "fem/shell/tables.hpp"

namespace drapeplan {

struct NoTables {};

template <int N, int A, bool kRates>
class ShellTerm : public Shell {
 public:
  ShellTerm(const Mesh& mesh, const Fabric& fabric, const FemOptions& options)
      : mesh_(mesh),
        material_(kernel_material(fabric, options)),
        fibre_slope_(material_.fibre.largest_slope()),
        slow_shear_slope_(fabric.shear.slowest().largest_slope()),
        shear_slope_(slow_shear_slope_),
        viscous_mass_(options.bulk_viscosity * options.mass_scaling * fabric.areal_density /
                      (SectionRule<N>::weight[N / 2] * fabric.thickness)),
        fibre_inertia_(options.fibre_mass_scaling > 1),
        bulk_viscosity_(options.bulk_viscosity) {
    if constexpr (kRates) {
      tables_ = rate_tables(fabric);
      fibre_slope_ = tables_.fibre.largest_slope(tables_.gain);
      shear_slope_ = tables_.shear.largest_slope(tables_.gain);
      lag_rate_ = options.time_scaling / fabric.rate_filter;
    }
    for (const auto& quad : mesh.quads) geometry_.push_back(element_geometry(mesh, quad));
    lay_blocks(mesh, geometry_, blocks_, geometries_);
  }

  [[nodiscard]] std::string_view name() const override { return kRates ? "shell with rates" : "shell"; }

  [[nodiscard]] std::vector<Forces> entries() const override {
    const int n = mesh_.node_count();
    return {{Book::internal, VectorField(n), VectorField(n)}};
  }

  void add_stiffness(NodalStiffness& stiffness) const override {
    const auto all = steepest_section(material_.thickness, fibre_slope_, shear_slope_);
    add_steepest(all, all, stiffness);
  }
  void add_slow_stiffness(NodalStiffness& stiffness) const override {
    const auto all =
        steepest_section(material_.thickness, material_.fibre.largest_slope(), slow_shear_slope_);
    add_steepest(all, all, stiffness);
  }
  void add_stiffness_without_fibres(NodalStiffness& stiffness) const override {
    const auto all = steepest_section(material_.thickness, fibre_slope_, shear_slope_);
    auto left = all;
    left.fibre1 = left.fibre2 = without_fibre_inertia(all.fibre1, 0.0, fibre_inertia_stretch());
    add_steepest(left, all, stiffness);
  }
  void add_fibre_stiffness(NodalStiffness& stiffness) const override {
    add_steepest(steepest_section(material_.thickness, material_.fibre.largest_slope(), 0),
                 steepest_section(material_.thickness, 0, 0), stiffness);
  }
  [[nodiscard]] std::vector<char> with_fibre_inertia() const override {
    std::vector<char> list;
    for (const Block& block : blocks_) list.insert(list.end(), size_t(block.used), block.rectangle);
    return list;
  }
  void set_fibre_inertia_step(double stable_dt) override {
    viscous_fibre_inertia_ =
        bulk_viscosity_ * fibre_inertia_slope() * stable_dt * stable_dt / (4 * SectionRule<N>::weight[N / 2]);
  }
  [[nodiscard]] double fibre_inertia_stretch() const override {
    return fibre_inertia_slope() * material_.thickness;
  }

  DRAPEPLAN_FLATTEN double look_at_sections(const State& state,
                                            std::vector<double>& sections) const override {
    const Rows<const double> x(state.position), d(state.director);
    double* at = sections.data();
    Lanes steepest(0.0);
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const ElementGeometry<Lanes>& g = geometries_[block.geometry];
      const Corners<Lanes> place = x.corners(block), along = d.corners(block);
      auto section = section_tangent<N, A>(g, material_, slopes_of(state, b), place, along);
      if (fibre_inertia_ && block.rectangle) {
        Lanes here = std::experimental::max(section.fibre1.steepest(), section.fibre2.steepest());
        clear_idle(block, here);
        steepest = std::experimental::max(steepest, here);
        leave_without_fibre_inertia(g, motion_products(element_motion(g, place, along)), section);
      }
      for (const Lanes* part : section.parts()) {
        store(*part, at);
        at += kLanes;
      }
    }
    return (1 + kFibreInertiaMargin) * std::experimental::hmax(steepest) / fibre_inertia_stretch();
  }

  [[nodiscard]] size_t section_count() const override {
    return SectionStiffness<Lanes>().parts().size() * slot_stride();
  }

  DRAPEPLAN_FLATTEN void add_bounds(const std::vector<double>& sections, const std::vector<double>& lightness,
                                    NodalStiffness& stiffness) const override {
    const double* at = sections.data();
    for (const Block& block : blocks_) {
      const ElementGeometry<Lanes>& g = geometries_[block.geometry];
      SectionStiffness<Lanes> section;
      for (Lanes* part : section.parts()) {
        *part = load(at);
        at += kLanes;
      }
      Lanes bound = element_bound(g, material_, section, corner_shares(block, lightness));
      if (block.used < kLanes) clear_idle(block, bound);
      const Lanes turn = bound * gyration_squared(g, material_.thickness);
      if (block.in_row) {
        for (const size_t c : {size_t(0), size_t(3)}) {
          add_row(stiffness.translation.data(), size_t(block.node[c][0]), bound, bound);
          add_row(stiffness.rotation.data(), size_t(block.node[c][0]), turn, turn);
        }
        continue;
      }
      for (size_t c = 0; c < 4; ++c) {
        for (size_t l = 0; l < size_t(block.used); ++l) {
          if (block.twins && block.node[c][l] == block.node[(c + 1) % 4][l]) continue;  // counted there
          const auto node = size_t(block.node[c][l]);
          stiffness.translation[node] += bound[l];
          stiffness.rotation[node] += turn[l];
        }
      }
    }
  }

  // Inlined as a whole: lanes then stay in registers between the steps of the kernel.
  DRAPEPLAN_FLATTEN void forces(State& state, Forces* entries) const override {
    entries->force.fill(0);
    entries->moment.fill(0);
    const Rows<const double> x(state.position), d(state.director);
    const Rows<double> force(entries->force), moment(entries->moment);
    // The stiffest fibre that the stable step dt allows has a stress per strain of density (length / dt)^2,
    // length = 2 half: stress = ratio times that, times the change of strain in a step, is the stated damping
    // ratio.
    const double viscous = 4 * viscous_mass_ / (state.stable_dt * state.stable_dt);
    const double follow = kRates ? -std::expm1(-state.dt * lag_rate_) : 0;
    const size_t stride = slot_stride();
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const ElementGeometry<Lanes>& g = geometries_[block.geometry];
      auto law = law_of(state, b, follow);
      double* before = &state.history[b * size_t(kLanes)];
      const Lanes added(block.rectangle ? 4 * viscous_fibre_inertia_ / (state.stable_dt * state.stable_dt)
                                        : 0.0);
      FibreViscosity<Lanes, A> viscosity{
          {Lanes(viscous) * g.half1 * g.half1 + added, Lanes(viscous) * g.half2 * g.half2 + added}, {}};
      for (size_t k = 0; k < kStrainSlots; ++k) viscosity.strain[k] = load(before + k * stride);
      Corners<Lanes> f, m;
      const Corners<Lanes> at = x.corners(block), along = d.corners(block);
      if (block.rectangle) {
        shell_forces<N, A, true>(g, material_, law, viscosity, at, along, f, m);
      } else {
        shell_forces<N, A, false>(g, material_, law, viscosity, at, along, f, m);
      }
      for (size_t k = 0; k < kStrainSlots; ++k) store(viscosity.strain[k], before + k * stride);
      add_forces(block, f, m, force, moment);
    }
  }

  [[nodiscard]] ShellEnergy stored_energy(const State& state) const override {
    ShellEnergy sum;
    for (size_t e = 0; e < mesh_.quads.size(); ++e) {
      const ElementEnergy energy =
          shell_energy<N, A>(geometry_[e], material_, corners(state.position, e), corners(state.director, e));
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
      const auto m = element_motion(geometry_[e], corners(state.position, e), corners(state.director, e));
      const double length1 = std::sqrt(dot(m.a1, m.a1)), length2 = std::sqrt(dot(m.a2, m.a2));
      snapshot.shear[e] = std::asin(std::clamp(dot(m.a1, m.a2) / (length1 * length2), -1.0, 1.0));
      snapshot.warp_strain[e] = length1 - 1;
      snapshot.weft_strain[e] = length2 - 1;
    }
  }

  void set_lagged_strains(State& state, double by) const override {
    if constexpr (kRates) {
      for (size_t slot = 0; slot < kLawSlots; ++slot) {
        const bool angle = slot < 3 * size_t(N) && slot % 3 == 2;
        double* lagged = &state.history[(kStrainSlots + slot) * slot_stride()];
        for (size_t e = 0; e < slot_stride(); ++e) lagged[e] += angle && lagged[e] > 0 ? -by : by;
      }
    }
  }

  [[nodiscard]] size_t history_count() const override {
    return (kStrainSlots + (kRates ? kLawSlots : 0)) * slot_stride();
  }

 protected:
  /// Adds what the elements of a block do to its nodes.
  static void add_forces(const Block& block, Corners<Lanes>& f, Corners<Lanes>& m, const Rows<double>& force,
                         const Rows<double>& moment) {
    if (block.in_row) {
      if (block.used < kLanes) clear_idle(block, f), clear_idle(block, m);
      force.add_in_row(block, f);
      moment.add_in_row(block, m);
    } else {
      force.add_anywhere(block, f);
      moment.add_anywhere(block, m);
    }
  }

  /// State::history has slots of one strain per element: mid-thickness strains of both fibres at the step
  /// before, by point across; then, with rates, the lagged strains of the law's slots.
  static constexpr size_t kStrainSlots = 2 * A;
  static constexpr size_t kLawSlots = 3 * size_t(N) + 2 * size_t(A - 1);

  [[nodiscard]] CornerShares<Lanes> corner_shares(const Block& block,
                                                  const std::vector<double>& lightness) const {
    CornerShares<Lanes> shares;
    for (size_t c = 0; c < 4; ++c) {
      const auto& node = block.node[c];
      const auto& next = block.node[(c + 1) % 4];
      shares.lightness[c] = block.in_row ? load(&lightness[size_t(node[0])]) : pick(lightness.data(), node);
      shares.twin[c] = block.twins
                           ? Lanes([&](auto l) { return node[size_t(l)] == next[size_t(l)] ? 1.0 : 0.0; })
                           : Lanes(0.0);
    }
    return shares;
  }

  /// Modulus that mass on edges carries, with a margin for what couples stretch to curvature [Pa].
  [[nodiscard]] double fibre_inertia_slope() const { return (1 + kFibreInertiaMargin) * fibre_slope_; }

  /// Takes away what mass on edges carries. It acts along the edges; fibres in between are at a small angle,
  /// and the square of its sine is left.
  void leave_without_fibre_inertia(const ElementGeometry<Lanes>& g, const MotionProducts<Lanes>& m,
                                   SectionStiffness<Lanes>& section) const {
    const Lanes off1 = g.across1 * g.across1 * (m.hh - m.a1h * m.a1h / m.a11) / m.a11;
    const Lanes off2 = g.across2 * g.across2 * (m.hh - m.a2h * m.a2h / m.a22) / m.a22;
    section.fibre1 = without_fibre_inertia(section.fibre1, off1, Lanes(fibre_inertia_stretch()));
    section.fibre2 = without_fibre_inertia(section.fibre2, off2, Lanes(fibre_inertia_stretch()));
  }

  /// In the rest shape, with one section for elements whose fibres added mass may carry and one for others.
  void add_steepest(const SectionStiffness<double>& of_fibre_inertia, const SectionStiffness<double>& others,
                    NodalStiffness& stiffness) const {
    const std::vector<char> with_fibre_inertia = this->with_fibre_inertia();
    for (size_t e = 0; e < mesh_.quads.size(); ++e) {
      const auto& section = with_fibre_inertia[e] ? of_fibre_inertia : others;
      const auto& quad = mesh_.quads[e];
      CornerShares<double> shares{{1, 1, 1, 1}, {0, 0, 0, 0}};
      for (size_t c = 0; c < 4; ++c) shares.twin[c] = quad[c] == quad[(c + 1) % 4] ? 1 : 0;
      const double bound = element_bound(geometry_[e], material_, section, shares);
      const double gyration2 = gyration_squared(geometry_[e], material_.thickness);
      for (size_t c = 0; c < 4; ++c) {
        if (shares.twin[c] > 0) continue;  // counted at the next corner
        stiffness.translation[size_t(quad[c])] += bound;
        stiffness.rotation[size_t(quad[c])] += bound * gyration2;
      }
    }
  }
  [[nodiscard]] size_t slot_stride() const { return blocks_.size() * size_t(kLanes); }

  auto slopes_of(const State& state, size_t block) const {
    if constexpr (kRates) {
      return RateSlopes(tables_, &state.history[kStrainSlots * slot_stride() + block * size_t(kLanes)],
                        slot_stride());
    } else {
      return StaticLaw(material_);
    }
  }
  auto law_of(State& state, size_t block, double follow) const {
    if constexpr (kRates) {
      return RateLaw(tables_, &state.history[kStrainSlots * slot_stride() + block * size_t(kLanes)],
                     slot_stride(), follow);
    } else {
      return StaticLaw(material_);
    }
  }

  [[nodiscard]] Corners<double> corners(const VectorField& field, size_t element) const {
    Corners<double> out;
    for (size_t c = 0; c < 4; ++c) {
      const auto node = size_t(mesh_.quads[element][c]);
      out[c] = {field.x[node], field.y[node], field.z[node]};
    }
    return out;
  }

  Mesh mesh_;
  KernelMaterial material_;
  double fibre_slope_, slow_shear_slope_, shear_slope_;  ///< steepest, instantaneous ones with rates [Pa]
  /// Damping ratio times scaled mass per area, over the middle point's weight [kg/m^3].
  double viscous_mass_;
  bool fibre_inertia_;
  double bulk_viscosity_;
  /// The same as viscous_mass_ of mass on edges, per volume and squared element length [Pa s^2].
  double viscous_fibre_inertia_ = 0;
  double lag_rate_ = 0;  ///< of lagged strains, in the simulation's time [1/s]
  std::conditional_t<kRates, RateTables, NoTables> tables_;
  std::vector<ElementGeometry<double>> geometry_;
  std::vector<Block> blocks_;
  std::vector<ElementGeometry<Lanes>> geometries_;
};

/// Builds the term for a number of section points; instantiated in files of their own, since each takes long
/// to compile.
template <int N>
std::unique_ptr<Shell> make_shell_of(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  const auto with_rates = [&]<int A>(std::integral_constant<int, A>) -> std::unique_ptr<Shell> {
    if (options.rates && fabric.rate_dependent())
      return std::make_unique<ShellTerm<N, A, true>>(mesh, fabric, options);
    return std::make_unique<ShellTerm<N, A, false>>(mesh, fabric, options);
  };
  return options.fibre_points == 1 ? with_rates(std::integral_constant<int, 1>())
                                   : with_rates(std::integral_constant<int, 2>());
}

extern template std::unique_ptr<Shell> make_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);
extern template std::unique_ptr<Shell> make_shell_of<3>(const Mesh&, const Fabric&, const FemOptions&);
extern template std::unique_ptr<Shell> make_shell_of<5>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
