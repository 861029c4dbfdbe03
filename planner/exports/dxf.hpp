// Drawings in the plane as DXF of release 12, in ASCII, which every program for cutting reads.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace drapeplan {

struct DxfLayer {
  std::string name;
  int colour =
      7;  ///< of AutoCAD's index: 1 red, 2 yellow, 3 green, 4 cyan, 5 blue, 6 magenta, 7 black or white
};

/// Lengths go in in metres and out in millimetres. The header says so by $INSUNITS and $MEASUREMENT, which
/// are younger than release 12; readers pass over variables that they do not know.
class DxfDrawing {
 public:
  explicit DxfDrawing(std::vector<DxfLayer> layers) : layers_(std::move(layers)) {}

  void add_line(const std::string& layer, const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  /// Two lines along x and y. @param arm  from the middle to each end [m].
  void add_cross(const std::string& layer, const Eigen::Vector2d& middle, double arm);
  void add_closed(const std::string& layer, const std::vector<Eigen::Vector2d>& corners);
  void add_circle(const std::string& layer, const Eigen::Vector2d& centre, double radius);
  /// One line of text from its lower left corner. Release 12 has no Unicode: what is not ASCII becomes "?".
  void add_text(const std::string& layer, const Eigen::Vector2d& corner, double height,
                const std::string& text);

  /// The file.
  [[nodiscard]] std::string text() const;

 private:
  void begin(const std::string& entity, const std::string& layer);
  void point(int first_code, const Eigen::Vector2d& place);

  std::vector<DxfLayer> layers_;
  std::string entities_;
};

}  // namespace drapeplan
