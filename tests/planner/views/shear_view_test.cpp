#include "planner/views/shear_view.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace drapeplan {
namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Snapshot flat(const Mesh& mesh, double shear) {
  Snapshot ply;
  for (const Eigen::Vector2d& rest : mesh.rest) ply.position.emplace_back(rest.x(), rest.y(), 0.01);
  ply.shear.assign(mesh.quads.size(), shear);
  return ply;
}

TEST(ShearView, HasEveryCellOfEveryPanelAndALargestValueOnItsBar) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.05);
  const Snapshot start = flat(mesh, 0);
  Snapshot end = flat(mesh, -0.2);  // 11.46 degrees
  const Mold plane(PlaneShape{}, {{-1, -1}, {1, 1}});
  const std::string svg = shear_picture({{"start <", &start}, {"end", &end}}, mesh, &plane);
  EXPECT_EQ(count(svg, "<path"), 2 * mesh.quads.size());
  EXPECT_EQ(count(svg, "start &lt;"), 1u);
  EXPECT_EQ(count(svg, ">12<"), 1u);
  EXPECT_EQ(count(svg, "nan"), 0u);
  end.position.front().x() = std::numeric_limits<double>::quiet_NaN();
  const std::string broken = shear_picture({{"end", &end}}, mesh, nullptr);
  EXPECT_EQ(count(broken, "<path"), mesh.quads.size() - 1);
  EXPECT_EQ(count(broken, "nan"), 0u);
}

TEST(ShearView, RefusesNoPanelsAndOthersMeshes) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.05);
  const Snapshot other = flat(rectangle_mesh(0.2, 0.1, 0.025), 0);
  EXPECT_THROW(shear_picture({}, mesh, nullptr), std::invalid_argument);
  EXPECT_THROW(shear_picture({{"other", &other}}, mesh, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
