// The kinematic mapping against KinDrape (C. Krogh and others, Struct. Multidisc. Optim. 64, 2021; MIT
// licence), run with the set-up of its Appendix B.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "mapping/article_mold.hpp"
#include "mapping/net.hpp"
#include "planner/validate/validate.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kShearTolerance = 0.3;  // [deg]
constexpr const char* kKinDrape = "KinDrape (Krogh and others 2021), run with least-shear generators";

/// The net of KinDrape's example: half a metre of the article's mold, 20 x 20 cells of 22 mm from the middle.
/// There the first edge along the weft lies above the y axis; here an angle says where the warp goes, so that
/// angle is sought.
Net article_net() {
  constexpr int kRounds = 6;  // the angle moves by less than round-off after them
  constexpr double kCell = 0.022, kSide = 20 * kCell;
  const Mold mold(article_mold().shape(), {{0, 0}, {0.5, 0.5}});
  const Eigen::Vector2d middle(0.25, 0.25);
  double angle = 0;
  Net net;
  for (int k = 0; k < kRounds; ++k) {
    net = map_ply(mold, {kSide, kSide, middle, angle}, {Generators::minimum_shear, middle, {0, 0}, kCell});
    const Eigen::Vector3d edge = net.node(10, 11) - net.node(10, 10);
    angle += std::atan2(edge.x(), edge.y());
  }
  return net;
}

Findings compare_article_net() {
  const Net net = article_net();
  const struct {
    int i, j;
    Eigen::Vector3d place;
  } published[] = {{0, 0, {0.02414, 0.06657, 0.07257}},
                   {20, 0, {0.44565, 0.04252, 0.02383}},
                   {0, 20, {0.07364, 0.49387, 0.06274}},
                   {20, 20, {0.44242, 0.47035, 0.02864}},
                   {20, 10, {0.46404, 0.25405, 0.05768}}};
  Findings result;
  for (const auto& p : published) {
    constexpr double kPlaceTolerance = 0.5;  // [mm]
    result.rows.push_back({fmt::format("article's mold, node ({}, {}): distance to theirs", p.i, p.j), "mm",
                           0, 1e3 * (net.node(p.i, p.j) - p.place).norm(), kPlaceTolerance, kKinDrape, ""});
  }
  const std::vector<double> shear = shear_field(net);
  double largest = 0, sum = 0;
  for (const double angle : shear) {
    largest = std::max(largest, std::abs(angle));
    sum += std::abs(angle);
  }
  result.rows.push_back({"article's mold, largest shear of a cell", "deg", 20.166, largest / kDegree,
                         kShearTolerance, kKinDrape, ""});
  result.rows.push_back({"article's mold, mean shear of the cells", "deg", 1.784,
                         sum / double(shear.size()) / kDegree, kShearTolerance, kKinDrape, ""});
  return result;
}

/// 24 x 24 nodes, 0.08 apart on the unit sphere. Lines of least shear are straight in the middle of the cells
/// beside them: with the start half a cell off the ply's middle the pole lies in the middle of the net's
/// middle cell.
Findings compare_sphere() {
  constexpr double kCell = 0.08;
  constexpr int kCells = 23, kMiddle = 11;
  constexpr double kPublished[] = {0.367,  1.467,  3.300,  5.863,  9.154, 13.161,
                                   17.867, 23.246, 29.256, 35.839, 42.919};  // [deg]
  const Mold mold(SphereShape{{0, 0, 0}, 1}, {{-1, -1}, {1, 1}});
  const Eigen::Vector2d off = Eigen::Vector2d::Constant(-0.5 * kCell);
  const Net net = map_ply(mold, {kCells * kCell, kCells * kCell, {0, 0}, 0},
                          {Generators::minimum_shear, {0, 0}, off, kCell});
  const std::vector<double> shear = shear_field(net);
  Findings result;
  for (int k = 1; k <= int(std::size(kPublished)); ++k) {
    const int cell = kMiddle + k;
    result.rows.push_back({fmt::format("unit sphere, cell {} along the diagonal: shear", k), "deg",
                           kPublished[k - 1], std::abs(shear[size_t(cell + cell * kCells)]) / kDegree,
                           kShearTolerance, kKinDrape, ""});
  }
  return result;
}

}  // namespace

void add_mapping_comparisons(std::vector<Comparison>& comparisons) {
  comparisons.push_back({"mapping", "net on the article's mold", compare_article_net});
  comparisons.push_back({"mapping", "net on a sphere", compare_sphere});
}

}  // namespace drapeplan
