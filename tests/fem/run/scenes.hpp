// Small scenes and states that several tests share.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "fem/model/model.hpp"
#include "mapping/mold.hpp"

namespace drapeplan::test {

/// Linear law: fibres of modulus E, shear modulus G, transverse shear modulus G13; 0.3 mm, 314 g/m^2.
inline Fabric linear_fabric(double E, double G, double G13) {
  Fabric fabric;
  fabric.thickness = 3e-4;
  fabric.areal_density = 0.314;
  fabric.tension = Curve{{0, 0.01}, {0, 0.01 * E}};
  fabric.compression = fabric.tension;
  fabric.shear = Curve{{0, 1}, {0, G}};
  fabric.transverse_shear_modulus = G13;
  return fabric;
}

/// A fabric with the article's traits: convex tension, soft compression, shear with plateau and locking.
inline Fabric woven_fabric() {
  Fabric fabric = linear_fabric(0, 0, 2e5);
  fabric.tension = Curve{{0, 0.001, 0.003, 0.0067}, {0, 5.6e6, 23.5e6, 66.7e6}};
  fabric.compression = Curve{{0, 0.001, 0.02}, {0, 0.53e6, 1.43e6}};
  const double degree = std::numbers::pi / 180;
  fabric.shear = Curve{{0, 10 * degree, 35 * degree, 50 * degree}, {0, 0.09e6, 0.11e6, 0.4e6}};
  return fabric;
}

/// Mesh of the unit ply with inner nodes moved, so that quadrilaterals are not parallelograms.
inline Mesh distorted_mesh(double width, double height, double size, double amount) {
  Mesh mesh = rectangle_mesh(width, height, size);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-amount * size, amount * size);
  for (Eigen::Vector2d& x : mesh.rest) {
    const bool inner = std::abs(x.x()) < 0.499 * width && std::abs(x.y()) < 0.499 * height;
    const Eigen::Vector2d by(move(random), move(random));
    if (inner) x += by;
  }
  return mesh;
}

inline Eigen::Vector3d get(const VectorField& field, size_t n) {
  return {field.x[n], field.y[n], field.z[n]};
}
inline void put(VectorField& field, size_t n, const Eigen::Vector3d& value) {
  field.x[n] = value.x();
  field.y[n] = value.y();
  field.z[n] = value.z();
}

/// Moves every node by up to `size` [m] and turns every director by up to `angle` [rad].
inline void disturb(State& state, int nodes, double size, double angle, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (size_t n = 0; n < size_t(nodes); ++n) {
    const Eigen::Vector3d move(unit(random), unit(random), unit(random)),
        turn(unit(random), unit(random), unit(random));
    put(state.position, n, get(state.position, n) + size * move);
    put(state.director, n, (get(state.director, n) + angle * turn).normalized());
  }
}

/// Turns the whole state about the origin.
inline void rotate(State& state, int nodes, const Eigen::Matrix3d& by) {
  for (size_t n = 0; n < size_t(nodes); ++n) {
    for (VectorField* field : {&state.position, &state.velocity, &state.director, &state.director_rate})
      put(*field, n, by * get(*field, n));
  }
}

}  // namespace drapeplan::test
