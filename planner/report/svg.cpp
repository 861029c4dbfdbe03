#include "planner/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

constexpr int kDecimals = 2;  // of a coordinate: 1/100 pixel

std::string number(double value) {
  return fixed(value, kDecimals);
}

std::string attribute(const std::string& name, const std::string& value) {
  return fmt::format(" {}=\"{}\"", name, value);
}

std::string attributes(const Svg::Style& style) {
  std::string text = attribute("fill", style.fill.empty() ? "none" : style.fill);
  if (!style.stroke.empty()) {
    text +=
        fmt::format(" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
                    style.stroke, number(style.width));
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
  return fmt::format("#{:02x}{:02x}{:02x}", srgb_byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                     srgb_byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                     srgb_byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s));
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

double text_width(const std::string& text, double size) {
  constexpr double kLetter = 0.56;  // mean width of a letter of wide fonts, over its size
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) !=
           0x80u;  // bytes that do not go on with a character of UTF-8
  });
  return kLetter * size * double(letters);
}

Svg::Svg(double width, double height, const std::string& title) {
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Inter, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif\">\n"
      "<title>{2}</title>\n",
      number(width), number(height), escape_markup(title));
  rectangle({0, 0}, {width, height}, {.fill = "#ffffff"});
}

void Svg::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Style& style) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", number(a.x()), number(a.y()),
                       number(b.x()), number(b.y()), attributes(style));
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& points, const Style& style) {
  std::string places;
  for (const auto& p : points) {
    places += fmt::format("{}{},{}", places.empty() ? "" : " ", number(p.x()), number(p.y()));
  }
  body_ += fmt::format("<polyline points=\"{}\"{}/>\n", places, attributes(style));
}

void Svg::rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Style& style,
                    double radius) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}{}/>\n", number(corner.x()),
                       number(corner.y()), number(size.x()), number(size.y()),
                       radius > 0 ? attribute("rx", number(radius)) : "", attributes(style));
}

void Svg::circle(const Eigen::Vector2d& centre, double radius, const Style& style) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(centre.x()), number(centre.y()),
                       number(radius), attributes(style));
}

void Svg::path(const std::string& data, const Style& style) {
  body_ += fmt::format("<path d=\"{}\"{}/>\n", data, attributes(style));
}

void Svg::text(const Eigen::Vector2d& place, const std::string& text, const TextStyle& style) {
  const char* anchor = style.anchor == Anchor::start    ? "start"
                       : style.anchor == Anchor::middle ? "middle"
                                                        : "end";
  const std::string x = number(place.x()), y = number(place.y()), content = escape_markup(text);
  std::string common =
      fmt::format("x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\"", x, y, number(style.size), anchor);
  if (style.bold) common += attribute("font-weight", "600");
  if (style.turn != 0) common += fmt::format(" transform=\"rotate({} {} {})\"", number(style.turn), x, y);
  // The rim is a text of its own below the letters: `paint-order` is not known to every renderer.
  if (style.halo) {
    body_ += fmt::format(
        "<text {} fill=\"#ffffff\" stroke=\"#ffffff\" stroke-width=\"3.5\" stroke-linejoin=\"round\" "
        "opacity=\"0.9\">{}</text>\n",
        common, content);
  }
  body_ += fmt::format("<text {} fill=\"{}\">{}</text>\n", common, style.colour, content);
}

void Svg::open_window(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
  // A nested document clips without needing an id.
  body_ += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" overflow=\"hidden\">\n",
                       number(corner.x()), number(corner.y()), number(size.x()), number(size.y()));
}

void Svg::close_window() {
  body_ += "</svg>\n";
}

Bands bands_up_to(double largest) {
  constexpr int kMostBands = 14;
  const double step = nice_step(largest, kMostBands);
  return {step, std::max(1, int(std::ceil(largest / step * (1 - 1e-9))))};
}

void draw_colour_bar(Svg& svg, const Eigen::Vector2d& corner, double height, const Bands& bands, double shown,
                     const std::string& title) {
  constexpr double kWidth = 16;
  const double band_height = height / bands.count;
  const int decimals = decimals_of(shown * bands.step);
  for (int band = 0; band < bands.count; ++band) {
    const double top = corner.y() + height - (band + 1) * band_height;
    svg.rectangle({corner.x(), top}, {kWidth, band_height + (band > 0 ? 0.5 : 0)},
                  {.fill = bands.colour(band)});
  }
  svg.rectangle(corner, {kWidth, height}, {.stroke = ink::kSoft, .width = 0.8});
  for (int band = 0; band <= bands.count; ++band) {
    const double y = corner.y() + height - band * band_height;
    svg.line({corner.x() + kWidth, y}, {corner.x() + kWidth + 4, y}, {.stroke = ink::kSoft, .width = 0.8});
    svg.text({corner.x() + kWidth + 8, y + 4}, fixed(shown * band * bands.step, decimals),
             {.size = 11, .colour = ink::kSoft});
  }
  svg.text({corner.x() + 62, corner.y() + 0.5 * height}, title,
           {.size = 12, .anchor = Svg::Anchor::middle, .turn = -90});
}

}  // namespace drapeplan
