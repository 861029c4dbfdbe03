// Pictures of a strip that bends under its weight, and the line along its middle.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace drapeplan {

/// Grey levels, 0 black to 255 white; the top row first.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> levels;
  [[nodiscard]] std::uint8_t at(int column, int row) const {
    return levels[size_t(row) * size_t(width) + size_t(column)];
  }
};

/// Reads a PNG, PGM, PPM or JPEG file; colours become grey. PGM and PPM have 8 bits for each level.
/// @throws WrongInput with the file and the reason.
GreyImage read_image(const std::filesystem::path& file);

struct StripImageOptions {
  double scale = 0;        ///< size of a pixel [m]
  double threshold = 0.5;  ///< between black and white: what is brighter is strip
  bool dark = false;       ///< what is darker is strip
  bool clamp_right = false;
  int smallest_area = 50;  ///< smaller patches are no strip [pixels]
};

/// The strip's middle, column by column, from the clamp on: x away from the clamp, y up [m]; the first point is
/// the origin. [Krogh], "Cantilever Test": threshold, small areas removed, mean row of each column. The largest
/// patch is the strip.
/// @throws WrongInput if there is no strip, a second patch of comparable size, or if the strip reaches the lower edge
/// of the picture or the one opposite its clamp, where its tip may be cut off.
std::vector<Eigen::Vector2d> strip_midline(const GreyImage& image, const StripImageOptions& options);

}  // namespace drapeplan
