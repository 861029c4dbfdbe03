// The slit annular plate under a lifting line load: large rotations with twist, fibres oblique to the
// elements.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kInner = 6, kOuter = 10;  // Sze, Liu, Lo (2004), section 3.4: E 21e6, nu 0, thickness 0.03

/// Deflections of the loaded edge's inner and outer ends under `load` per length, across by around elements.
std::array<double, 2> lifted(int across, int around, double thickness, double load) {
  // The same bending stiffness as the published plate.
  const test::Sheet sheet{21e6 * std::pow(0.03 / thickness, 3), thickness, 1};
  Scene scene;
  scene.mesh = test::grid(across, around, [](double u, double v) {
    const double r = kInner + u * (kOuter - kInner), angle = 2 * std::numbers::pi * v;
    return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
  });
  scene.fabric = sheet.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 2 * sheet.frequency(3.5, 25);
  Loads loads;
  const int last = around * (across + 1);
  for (int i = 0; i <= across; ++i) {
    scene.clamped.push_back(i);
    const double share = (i == 0 || i == across ? 0.5 : 1.0) * (kOuter - kInner) / across;
    loads.forces.push_back({last + i, {0, 0, load * share}});
  }
  scene.loads = loads;
  const Model model(scene);
  const State state = test::at_rest(model, 1e-3);
  std::printf("  %lld steps\n", static_cast<long long>(state.step));
  return {state.x.z[size_t(last)], state.x.z[size_t(last + across)]};
}

TEST(Annulus, LiftsLikeThePublishedSlitPlate) {
  for (const auto& mesh : {std::array{4, 24}, {6, 36}})
    for (double t : {0.3, 0.1}) {
      const auto w = lifted(mesh[0], mesh[1], t, 0.8);
      printf("%d %d t %g\n", mesh[0], mesh[1], t);
      test::figure("slit annulus, W_A", w[0], 13.891);
      test::figure("slit annulus, W_B", w[1], 17.528);
    }
}

}  // namespace
}  // namespace drapeplan
