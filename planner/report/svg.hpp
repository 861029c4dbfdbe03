// The few drawing strokes that pictures and charts share. Coordinates are SVG pixels, y downwards.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace drapeplan {

/// Colours of all pictures.
namespace ink {
inline constexpr const char* kText = "#1d2733";
inline constexpr const char* kSoft = "#5b6775";     ///< secondary text, ticks
inline constexpr const char* kGrid = "#dfe4ea";     ///< grid lines, frames
inline constexpr const char* kSurface = "#f3f5f7";  ///< the mold, plot background
inline constexpr const char* kBoundary = "#d7263d";
}  // namespace ink

/// Colour of share t in [0, 1], from pale yellow to deep blue, as "#rrggbb". Lightness falls in equal steps
/// of the Oklab colour space (B. Ottosson, 2020), so equal steps of the value look equally large, in grey as
/// well.
std::string sequential_colour(double t);

/// The smallest of 1, 2, 2.5 or 5 times a power of ten that splits `range` into at most `most` steps. range >
/// 0.
double nice_step(double range, int most);

/// Digits after the point that a multiple of `step` needs, at most 6.
int decimals_of(double step);

/// Width of a text in a wide font, so that what stands beside it is not covered [px]. @param size  of the
/// letters [px].
double text_width(const std::string& text, double size);

/// An SVG document that is written from top to bottom. It uses no ids, so several may stand in one HTML page.
class Svg {
 public:
  enum class Anchor { start, middle, end };
  /// How a shape is drawn; an empty colour is not drawn.
  struct Style {
    std::string fill = "", stroke = "";
    double width = 1;  ///< of the stroke
    double opacity = 1;
    std::string dash = "";  ///< "4 3"
  };
  struct TextStyle {
    double size = 12;
    Anchor anchor = Anchor::start;
    bool bold = false;
    std::string colour = ink::kText;
    double turn = 0;    ///< [deg], clockwise about its anchor
    bool halo = false;  ///< white rim, for text on a picture
  };

  Svg(double width, double height, const std::string& title);

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Style& style);
  void polyline(const std::vector<Eigen::Vector2d>& points, const Style& style);
  void rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Style& style,
                 double radius = 0);
  void circle(const Eigen::Vector2d& centre, double radius, const Style& style);
  void path(const std::string& data, const Style& style);
  /// `text` is escaped here.
  void text(const Eigen::Vector2d& place, const std::string& text, const TextStyle& style);

  /// What follows until `close_window` counts from `corner` and is cut off outside the window. A dark page
  /// turns the ink outside of windows light (page.css); what has its own colours belongs in one, on
  /// `ink::kSurface`.
  void open_window(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);
  void close_window();

  [[nodiscard]] std::string finish() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
};

/// Equal bands of a value from zero up, and their colours.
struct Bands {
  double step = 1;  ///< in the unit of the value
  int count = 1;
  [[nodiscard]] std::string colour(int band) const {
    return sequential_colour(count > 1 ? double(band) / (count - 1) : 0);
  }
};

/// Bands of a round width up to `largest` > 0, at most 14.
Bands bands_up_to(double largest);

/// A bar of the bands with their limits, upwards; with ticks and title it is 104 px wide.
/// @param shown  factor from the unit of the value to that of the title.
void draw_colour_bar(Svg& svg, const Eigen::Vector2d& corner, double height, const Bands& bands, double shown,
                     const std::string& title);

}  // namespace drapeplan
