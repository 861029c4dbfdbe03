// How near a mold that was fitted to triangles comes to the surface they are taken from, and what it costs:
// the figures of mapping/README.md. Usage: mold_bench
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include "mapping/net.hpp"
#include "mapping/surface/upper_surface.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/mapping/surface/meshes.hpp"

namespace drapeplan {
namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void show_fit(int facets) {
  const Mold exact = article_mold();
  const Triangles mesh =
      triangulated([&](double x, double y) { return exact.height(x, y); }, exact.extent(), facets, facets);
  UpperSurface surface;
  const double seconds = seconds_of([&] { surface = upper_surface(mesh, {}); });
  const Mold mold(surface.spline, surface.extent);
  constexpr int kPlaces = 100;  // along one side
  double height = 0, normal = 0, second = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    for (int j = 0; j <= kPlaces; ++j) {
      const double x = 0.45 * i / kPlaces, y = 0.45 * j / kPlaces;
      const Jet f = mold.jet(x, y), g = exact.jet(x, y);
      height = std::max(height, std::abs(f.z - g.z));
      normal = std::max(normal, (mold.normal(x, y) - exact.normal(x, y)).norm());
      second = std::max({second, std::abs(f.zxx - g.zxx), std::abs(f.zxy - g.zxy), std::abs(f.zyy - g.zyy)});
    }
  }
  fmt::print(
      "{:6} triangles: height {:6.2f} um, normal {:5.2f} mrad, second derivatives {:5.2f} 1/m, facets "
      "{:5.3f} mm, "
      "{:.3f} s\n",
      mesh.corners.size(), 1e6 * height, 1e3 * normal, second, 1e3 * surface.facets.largest, seconds);
}

Mold spline_of(int cells) {
  SplineShape shape{{0, 0}, {0.45 / cells, 0.45 / cells}, Eigen::MatrixXd(cells + 3, cells + 3)};
  for (int i = 0; i < cells + 3; ++i) {
    for (int j = 0; j < cells + 3; ++j) shape.coefficients(i, j) = 0.01 * std::sin(i) * std::cos(j);
  }
  return Mold(shape, {{0, 0}, {0.45, 0.45}});
}

/// The best of many batches over the nodes of a mesh.
void show_heights(const char* name, const Mold& mold) {
  constexpr int kSide = 80, kRuns = 300;
  std::vector<double> x, y;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j)
      x.push_back(0.45 * (i + 0.3) / kSide), y.push_back(0.45 * (j + 0.4) / kSide);
  }
  std::vector<double> z(x.size()), zx(z), zy(z);
  double best = 1;
  for (int run = 0; run < kRuns; ++run)
    best = std::min(best, seconds_of([&] {
                      mold.heights(int(x.size()), x.data(), y.data(), z.data(), zx.data(), zy.data());
                    }));
  fmt::print("heights, {:20} {:5.2f} ns per point\n", name, 1e9 * best / double(x.size()));
}

void show_large() {
  const Extent extent{{-2.2, -2.2}, {2.2, 2.2}};
  const Mold formula(PolynomialShape{{{2, 0, -.03}, {0, 2, -.04}, {1, 1, .01}, {3, 0, .004}, {2, 3, .0003}}},
                     extent);
  const Triangles mesh =
      triangulated([&](double x, double y) { return formula.height(x, y); }, extent, 65, 65);
  UpperSurface surface;
  const double fit = seconds_of([&] { surface = upper_surface(mesh, {}); });
  Ply ply;
  ply.width = ply.height = 4;
  MappingOptions options;
  options.cell_size = 0.0125;
  const Mold mold(surface.spline, surface.extent);
  const double map = seconds_of([&] { static_cast<void>(map_ply(mold, ply, options)); });
  const double same = seconds_of([&] { static_cast<void>(map_ply(formula, ply, options)); });
  fmt::print(
      "4 m ply, 12.5 mm cells, {} triangles: fit {:.3f} s, map {:.3f} s, map onto the formula {:.3f} s\n",
      mesh.corners.size(), fit, map, same);
}

}  // namespace
}  // namespace drapeplan

int main() {
  using namespace drapeplan;
  for (const int facets : {24, 45, 90}) show_fit(facets);
  show_heights("cubic", article_mold());
  show_heights("degree 5", Mold(PolynomialShape{{{5, 0, 3.0}, {2, 3, -7.0}, {1, 4, 2.0}}}, {{0, 0}, {1, 1}}));
  for (const int cells : {16, 64, 128})
    show_heights(fmt::format("{} x {} cells", cells, cells).c_str(), spline_of(cells));
  show_large();
}
