#include "fem/model/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/terms/contact.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

/// Smallest radius of curvature of the mold's sections over the longest element edge: below it a mesh of flat
/// elements has nothing in common with the mold, and a ball slips between its nodes.
constexpr double kLeastRadius = 1;

double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (const auto& quad : mesh.quads) {
    for (size_t c = 0; c < 4; ++c)
      longest = std::max(longest, (mesh.rest[size_t(quad[c])] - mesh.rest[size_t(quad[(c + 1) % 4])]).norm());
  }
  return longest;
}

/// Largest principal curvature of a height field: roots with mean H and product K [1/m].
double largest_curvature(const Jet& jet) {
  const double stretch2 = 1 + jet.zx * jet.zx + jet.zy * jet.zy;
  const double product = (jet.zxx * jet.zyy - jet.zxy * jet.zxy) / (stretch2 * stretch2);
  const double mean =
      ((1 + jet.zy * jet.zy) * jet.zxx - 2 * jet.zx * jet.zy * jet.zxy + (1 + jet.zx * jet.zx) * jet.zyy) /
      (2 * std::pow(stretch2, 1.5));
  return std::abs(mean) + std::sqrt(std::max(mean * mean - product, 0.0));
}

/// Largest normal curvature of the mold where it is defined, in its extent [1/m].
double sharpest_curvature(const Mold& mold) {
  constexpr int kSamples = 101;  // per side: fewer than nodes in most plies, but molds are smooth formulas
  double sharpest = 0;
  const Extent& extent = mold.extent();
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Eigen::Vector2d share(double(i) / (kSamples - 1), double(j) / (kSamples - 1));
      const Eigen::Vector2d at = extent.lower + share.cwiseProduct(extent.upper - extent.lower);
      const Jet jet = mold.jet(at.x(), at.y());
      const double slope2 = jet.zx * jet.zx + jet.zy * jet.zy;
      if (!(slope2 < kSteepestContact * kSteepestContact)) continue;  // nothing touches there
      sharpest = std::max(sharpest, largest_curvature(jet));
    }
  }
  return sharpest;
}

void check_mold(const Scene& scene) {
  const double radius = 1 / std::max(sharpest_curvature(*scene.mold), 1e-12), edge = longest_edge(scene.mesh);
  if (radius < kLeastRadius * edge) {
    throw WrongInput(fmt::format(
        "the mold is curved with a radius of {:f} mm, elements are up to {:f} mm long: refine the mesh",
        1e3 * radius, 1e3 * edge));
  }
  if (scene.start != Start::on_mold) return;
  const Jet jet = scene.mold->jet(scene.position.x(), scene.position.y());
  if (!(std::hypot(jet.zx, jet.zy) < kSteepestContact)) {
    throw WrongInput(
        "the ply starts where the mold is too steep, or not defined: nothing touches a height field beyond "
        "84 degrees");
  }
}

}  // namespace

void check_scene(const Scene& scene) {
  if (scene.friction && !scene.mold) throw WrongInput("friction needs a mold");
  if (scene.tack) {
    const Tack& tack = *scene.tack;
    if (!scene.friction) throw WrongInput("tack needs friction");
    if (!(tack.stress >= 0 && tack.reach > 0 && std::isfinite(tack.stress) && std::isfinite(tack.reach)))
      throw WrongInput(
          fmt::format("tack: needs a stress >= 0 ({:g} Pa) and a reach > 0 ({:g} m), both finite",
                      tack.stress, tack.reach));
  }
  if (scene.start == Start::on_mold && (!scene.mold || scene.rig))
    throw WrongInput("a ply that starts on the mold needs a mold, and no rig");
  if (scene.mold) check_mold(scene);
  if (scene.press) check_press(*scene.press);
}

}  // namespace drapeplan
