#include "planner/report/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

constexpr int kDecimals = 2;  // of a coordinate: 1/100 pixel

std::string number(double value) {
  return fixed(value, kDecimals);
}

std::string attribute(const std::string& name, const std::string& value) {
  return std::string(" ").append(name).append("=\"").append(value).append("\"");
}

std::string attributes(const Svg::Style& style) {
  std::string text = attribute("fill", style.fill.empty() ? "none" : style.fill);
  if (!style.stroke.empty()) {
    text += attribute("stroke", style.stroke) + attribute("stroke-width", number(style.width)) +
            attribute("stroke-linejoin", "round") + attribute("stroke-linecap", "round");
  }
  if (!style.dash.empty()) text += attribute("stroke-dasharray", style.dash);
  if (style.opacity < 1) text += attribute("opacity", number(style.opacity));
  return text;
}

/// One channel of linear light as an sRGB byte (IEC 61966-2-1).
int srgb_byte(double linear) {
  const double clipped = std::clamp(linear, 0.0, 1.0);
  const double encoded = clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1 / 2.4) - 0.055;
  return int(std::lround(255 * encoded));
}

/// Oklab lightness, chroma and hue [deg] to "#rrggbb"; matrices from bottosson.github.io/posts/oklab.
std::string oklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue * std::numbers::pi / 180);
  const double b = chroma * std::sin(hue * std::numbers::pi / 180);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x",
                srgb_byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s) & 0xff,
                srgb_byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s) & 0xff,
                srgb_byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s) & 0xff);
  return text.data();
}

}  // namespace

std::string sequential_colour(double t) {
  // Ends chosen by eye: nearly white where the ply lies on the mold, dark but not black at the largest gap;
  // the chroma is largest in the middle and stays inside sRGB.
  t = std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.0;
  const double lightness = 0.975 - 0.675 * t;
  const double hue = 105 + 165 * t;
  const double chroma = 0.035 + 0.068 * std::sin(std::numbers::pi * std::pow(t, 0.85)) + 0.07 * t * t;
  return oklch(lightness, chroma, hue);
}

double nice_step(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  constexpr double kRound = 1 + 1e-9;  // so that 10 / 5 gives steps of 2, whatever the last bit says
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (range <= factor * power * most * kRound) return factor * power;
  }
  return 10 * power;
}

int decimals_of(double step) {
  constexpr int kMost = 6;
  for (int digits = 0; digits < kMost; ++digits) {
    const double scaled = step * std::pow(10, digits);
    if (std::abs(scaled - std::round(scaled)) < 1e-6 * scaled) return digits;
  }
  return kMost;
}

Svg::Svg(double width, double height, const std::string& title) {
  body_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "\" height=\"" +
          number(height) + "\" viewBox=\"0 0 " + number(width) + " " + number(height) +
          "\" font-family=\"Inter, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif\">\n<title>" +
          escape_markup(title) + "</title>\n";
  rectangle({0, 0}, {width, height}, {.fill = "#ffffff"});
}

void Svg::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Style& style) {
  body_ += "<line" + attribute("x1", number(a.x())) + attribute("y1", number(a.y())) +
           attribute("x2", number(b.x())) + attribute("y2", number(b.y())) + attributes(style) + "/>\n";
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& points, const Style& style) {
  std::string places;
  for (const auto& p : points) {
    places.append(places.empty() ? "" : " ").append(number(p.x())).append(",").append(number(p.y()));
  }
  body_ += "<polyline" + attribute("points", places) + attributes(style) + "/>\n";
}

void Svg::rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Style& style,
                    double radius) {
  body_ += "<rect" + attribute("x", number(corner.x())) + attribute("y", number(corner.y())) +
           attribute("width", number(size.x())) + attribute("height", number(size.y()));
  if (radius > 0) body_ += attribute("rx", number(radius));
  body_ += attributes(style) + "/>\n";
}

void Svg::circle(const Eigen::Vector2d& centre, double radius, const Style& style) {
  body_ += "<circle" + attribute("cx", number(centre.x())) + attribute("cy", number(centre.y())) +
           attribute("r", number(radius)) + attributes(style) + "/>\n";
}

void Svg::path(const std::string& data, const Style& style) {
  body_ += "<path" + attribute("d", data) + attributes(style) + "/>\n";
}

void Svg::text(const Eigen::Vector2d& place, const std::string& text, const TextStyle& style) {
  const char* anchor = style.anchor == Anchor::start    ? "start"
                       : style.anchor == Anchor::middle ? "middle"
                                                        : "end";
  std::string common = attribute("x", number(place.x())) + attribute("y", number(place.y())) +
                       attribute("font-size", number(style.size)) + attribute("text-anchor", anchor);
  if (style.bold) common += attribute("font-weight", "600");
  if (style.turn != 0) {
    const std::string about = number(style.turn) + " " + number(place.x()) + " " + number(place.y());
    common += attribute("transform", std::string("rotate(").append(about).append(")"));
  }
  const std::string content = std::string(">").append(escape_markup(text)).append("</text>\n");
  // The rim is a text of its own below the letters: `paint-order` is not known to every renderer.
  if (style.halo) {
    body_ += "<text" + common +
             " fill=\"#ffffff\" stroke=\"#ffffff\" stroke-width=\"3.5\" stroke-linejoin=\"round\"" +
             attribute("opacity", "0.9") + content;
  }
  body_ += "<text" + common + attribute("fill", style.colour) + content;
}

void Svg::open_window(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
  // A nested document clips without needing an id.
  body_ += "<svg" + attribute("x", number(corner.x())) + attribute("y", number(corner.y())) +
           attribute("width", number(size.x())) + attribute("height", number(size.y())) +
           attribute("overflow", "hidden") + ">\n";
}

void Svg::close_window() {
  body_ += "</svg>\n";
}

}  // namespace drapeplan
