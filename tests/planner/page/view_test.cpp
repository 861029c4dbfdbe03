#include "planner/page/view.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/base/base64.hpp"
#include "planner/page/view_fields.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHeight = 0.01;  // of the ply above the mold [m]

ViewScale four_bands(double largest) {
  return {.step = largest / 4, .colours = {"#ffffff", "#aaaaaa", "#555555", "#000000"}, .decimals = 1};
}

/// A ply of 200 by 100 mm at `kHeight` above a plane.
Scene plane_scene() {
  Scene scene;
  scene.mesh = rectangle_mesh(0.2, 0.1, 0.05);
  scene.mold = Mold(PlaneShape{}, {{-0.2, -0.2}, {0.2, 0.2}});
  return scene;
}

/// Level, turned about z by `angle` [rad].
Snapshot level(const Mesh& mesh, double time, double angle = 0) {
  Snapshot ply;
  ply.time = time;
  for (const Eigen::Vector2d& rest : mesh.rest) {
    const Eigen::Vector2d turned = Eigen::Rotation2Dd(angle) * rest;
    ply.position.emplace_back(turned.x(), turned.y(), kHeight);
  }
  ply.shear.assign(mesh.quads.size(), 0.1);
  return ply;
}

/// The net of that ply on the plane.
Net flat_net() {
  Net net;
  net.u = {-0.1, 0, 0.1};
  net.v = {-0.05, 0.05};
  for (const double v : net.v)
    for (const double u : net.u) net.nodes.emplace_back(u, v, 0);
  return net;
}

std::string markup(const Scene& scene, const std::vector<Snapshot>& frames, const std::string& name = "wave",
                   const MapResult* mapping = nullptr) {
  return view_markup({.drapes = {{name, &scene, &frames}}, .mapping = mapping, .scale = four_bands});
}

json data_of(const std::string& markup) {
  const std::string begin = "id=\"view-data\">";
  const size_t at = markup.find(begin) + begin.size();
  return json::parse(markup.substr(at, markup.find("</script>", at) - at));
}

std::vector<double> unpacked(const json& packed) {
  const auto bytes = bytes_of_base64(packed.at("data").get<std::string>());
  const auto lower = packed.at("lower").get<std::vector<double>>(),
             upper = packed.at("upper").get<std::vector<double>>();
  std::vector<double> numbers;
  for (size_t k = 0; 2 * k < bytes->size(); ++k) {
    const int number = (*bytes)[2 * k] + 256 * (*bytes)[2 * k + 1];
    const size_t c = k % lower.size();
    numbers.push_back(number == 65535 ? kNan : lower[c] + (upper[c] - lower[c]) * number / 65534);
  }
  return numbers;
}

TEST(View, HoldsPlacesAndFieldsOfEveryFrame) {
  const Scene scene = plane_scene();
  const std::vector<Snapshot> frames{level(scene.mesh, 0), level(scene.mesh, 2.5, 0.3)};
  const json data = data_of(markup(scene, frames));
  const json& drape = data.at("drapes").at(0);
  EXPECT_EQ(drape.at("times"), json({0.0, 2.5}));
  EXPECT_EQ(drape.at("quads").size(), 4 * scene.mesh.quads.size());
  const std::vector<double> places = unpacked(drape.at("position"));
  ASSERT_EQ(places.size(), 2 * 3 * scene.mesh.rest.size());
  const Vector3d last = frames.back().position.back();
  for (int c = 0; c < 3; ++c)
    EXPECT_LE(std::abs(places[places.size() - 3 + size_t(c)] - last[c]), 0.2 / 65534);
  for (const double gap : unpacked(drape.at("fields").at(0))) EXPECT_LE(std::abs(gap - 10), 1e-9);  // [mm]
  for (const double shear : unpacked(drape.at("fields").at(1)))
    EXPECT_LE(std::abs(shear - 0.1 / kDegree), 1e-9);
  EXPECT_TRUE(drape.at("fields").at(2).is_null()) << "there is no net";
  EXPECT_LE(std::abs(data.at("fields").at(0).at("step").get<double>() - 2.5), 1e-9);
}

TEST(View, WhatIsNotFiniteIsMarked) {
  const Scene scene = plane_scene();
  Snapshot broken = level(scene.mesh, 1);
  broken.position.front().y() = kNan;
  const json data = data_of(markup(scene, {broken}));
  const std::vector<double> places = unpacked(data.at("drapes").at(0).at("position"));
  EXPECT_TRUE(std::isnan(places[1]));
  EXPECT_TRUE(std::isfinite(places[4]));
}

TEST(View, NamesCannotEndTheScript) {
  const Scene scene = plane_scene();
  const std::string name = "</script><script>alert(1)</script><!-- \xff";
  const std::string text = markup(scene, {level(scene.mesh, 0)}, name);
  EXPECT_EQ(text.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(text.find("<!--"), std::string::npos);
  EXPECT_EQ(data_of(text).at("drapes").at(0).at("name"),
            "</script><script>alert(1)</script><!-- \xef\xbf\xbd");
}

TEST(View, IsEmptyWithoutFramesOrFinitePlaces) {
  const Scene scene = plane_scene();
  EXPECT_EQ(markup(scene, {}), "");
  Snapshot broken = level(scene.mesh, 0);
  for (Vector3d& place : broken.position) place.setConstant(kNan);
  EXPECT_EQ(markup(scene, {broken}), "");
}

TEST(View, LeavesFramesOutWhereTheTextWouldBeTooLong) {
  Scene scene = plane_scene();
  scene.mold.reset();
  scene.mesh = rectangle_mesh(0.2, 0.2, 0.002);  // some ten thousand nodes
  std::vector<Snapshot> frames;
  for (int k = 0; k < 101; ++k) frames.push_back(level(scene.mesh, k));
  const std::string text = markup(scene, frames);
  const json times = data_of(text).at("drapes").at(0).at("times");
  EXPECT_LE(text.size(), size_t(7e6));
  EXPECT_GE(times.size(), 20u);
  EXPECT_EQ(times.back(), 100.0);
}

TEST(FibreAngles, AreZeroOnTheNetAndSeeATurnAndAShear) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.05);
  const Net net = flat_net();
  for (const double offset : fibre_angle_offsets(mesh, level(mesh, 0).position, net))
    EXPECT_LE(offset, 1e-12);
  for (const double offset : fibre_angle_offsets(mesh, level(mesh, 0, -4 * kDegree).position, net))
    EXPECT_LE(std::abs(offset - 4 * kDegree), 1e-12);
  std::vector<Vector3d> sheared;  // the weft turns by 0.1, the warp stays; the heights are not seen
  for (const Eigen::Vector2d& rest : mesh.rest)
    sheared.emplace_back(rest.x() + std::tan(0.1) * rest.y(), rest.y(), rest.x());
  for (const double offset : fibre_angle_offsets(mesh, sheared, net))
    EXPECT_LE(std::abs(offset - 0.1), 1e-12);
}

TEST(FibreAngles, AreUnknownBesideTheNet) {
  const Mesh mesh = rectangle_mesh(0.4, 0.1, 0.1);
  const std::vector<double> offsets = fibre_angle_offsets(mesh, level(mesh, 0).position, flat_net());
  EXPECT_TRUE(std::isnan(offsets.front()));
  EXPECT_LE(offsets[1], 1e-12);
  EXPECT_LE(std::abs(share_within(mesh, offsets, 0.1) - 0.5), 1e-12) << "what is not known is not within";
}

TEST(FibreAngles, SharesAreOfTheArea) {
  Mesh mesh;
  mesh.rest = {{0, 0}, {1, 0}, {4, 0}, {0, 1}, {1, 1}, {4, 1}};
  mesh.quads = {{0, 1, 4, 3}, {1, 2, 5, 4}};
  EXPECT_LE(std::abs(share_within(mesh, {-0.1, 0.5}, 0.2) - 0.25), 1e-12);
  EXPECT_EQ(nodal_means(mesh, {1, 3}), (std::vector<double>{1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(nodal_means(mesh, {kNan, 3})[1], 3);
  EXPECT_TRUE(std::isnan(nodal_means(mesh, {kNan, 3})[0]));
}

}  // namespace
}  // namespace drapeplan
