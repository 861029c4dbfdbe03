// Cantilevers that nobody let go: how a strip of a known material creeps down, and pictures of it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <random>
#include <vector>

#include "fem/law/fabric.hpp"

namespace drapeplan::test {

/// A strip at an instant.
struct CreepingStrip {
  double time = 0;                      ///< since it was let go [s]
  std::vector<Eigen::Vector2d> places;  ///< equally spaced along it, from the clamp on; y is up [m]
  [[nodiscard]] double tip() const { return -places.back().y(); }
};

/// Assumed, as [Krogh] assumes it to find rates: at each instant the strip is at rest under its weight, with the
/// compression curve that its fibres have at one rate, that of the strain outside at the clamp. So the strip's
/// strain gives its rate, which gives its strain a moment later. It is the exact beam of beam.hpp, to which the slope
/// of transverse shear is added; it has nothing of the elements that simulate it later. At 0.4 s it has come down to
/// the drop of the fastest curve.
/// @param times  from 0.4 s on, increasing [s].
std::vector<CreepingStrip> creeping_strip(const Fabric& truth, double length, double gravity,
                                          const std::vector<double>& times);

/// Writes a grey picture of the strip, 0.5 mm thick as seen from the side, bright on dark: its clamp is on the left.
/// What spoils it: noise of the camera, and specks of dust.
/// @param file  PGM.  @param scale  of a pixel [m].  @param depth  below the clamp that is seen [m].
void write_picture(const std::filesystem::path& file, const CreepingStrip& strip, double scale, double depth,
                   std::mt19937_64& bits);

}  // namespace drapeplan::test
