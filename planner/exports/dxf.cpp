#include "planner/exports/dxf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace drapeplan {
namespace {

constexpr double kMillimetres = 1e3;

/// A group: the code says what the value is.
template <class Value>
std::string group(int code, const Value& value) {
  return fmt::format("{:3}\n{}\n", code, value);
}

/// A length in millimetres, to a nanometre; never "-0".
std::string length_group(int code, double metres) {
  return fmt::format("{:3}\n{:.6f}\n", code, kMillimetres * metres + 0.0);
}

std::string section(const std::string& name, const std::string& content) {
  return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
}

std::string table(const std::string& name, size_t entries, const std::string& content) {
  return group(0, "TABLE") + group(2, name) + group(70, entries) + content + group(0, "ENDTAB");
}

std::string header() {
  constexpr int kMetric = 1, kMillimetreUnits = 4, kDecimal = 2;
  return group(9, "$ACADVER") + group(1, "AC1009") + group(9, "$INSUNITS") + group(70, kMillimetreUnits) +
         group(9, "$MEASUREMENT") + group(70, kMetric) + group(9, "$LUNITS") + group(70, kDecimal);
}

std::string tables(const std::vector<DxfLayer>& layers) {
  const std::string solid = group(0, "LTYPE") + group(2, "CONTINUOUS") + group(70, 0) +
                            group(3, "Solid line") + group(72, 65) + group(73, 0) + group(40, "0.0");
  std::string names;
  for (const DxfLayer& layer : layers)
    names += group(0, "LAYER") + group(2, layer.name) + group(70, 0) + group(62, layer.colour) +
             group(6, "CONTINUOUS");
  const std::string style = group(0, "STYLE") + group(2, "STANDARD") + group(70, 0) + group(40, "0.0") +
                            group(41, "1.0") + group(50, "0.0") + group(71, 0) + group(42, "2.5") +
                            group(3, "txt") + group(4, "");
  return table("LTYPE", 1, solid) + table("LAYER", layers.size(), names) + table("STYLE", 1, style);
}

std::string ascii(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80) continue;  // goes on with a character of UTF-8
    if (byte >= 0x80)
      plain += '?';
    else
      plain += byte < ' ' || byte == 0x7F ? ' ' : c;
  }
  return plain;
}

}  // namespace

void DxfDrawing::begin(const std::string& entity, const std::string& layer) {
  if (std::none_of(layers_.begin(), layers_.end(), [&](const DxfLayer& one) { return one.name == layer; }))
    throw std::invalid_argument("DxfDrawing: there is no layer " + layer);
  entities_ += group(0, entity) + group(8, layer);
}

void DxfDrawing::point(int first_code, const Eigen::Vector2d& place) {
  if (!place.allFinite()) throw std::invalid_argument("DxfDrawing: a place that is not finite");
  entities_ += length_group(first_code, place.x()) + length_group(first_code + 10, place.y()) +
               length_group(first_code + 20, 0);
}

void DxfDrawing::add_line(const std::string& layer, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  begin("LINE", layer);
  point(10, from);
  point(11, to);
}

void DxfDrawing::add_cross(const std::string& layer, const Eigen::Vector2d& middle, double arm) {
  for (const Eigen::Vector2d& along : {Eigen::Vector2d(arm, 0), Eigen::Vector2d(0, arm)})
    add_line(layer, middle - along, middle + along);
}

void DxfDrawing::add_closed(const std::string& layer, const std::vector<Eigen::Vector2d>& corners) {
  constexpr int kClosed = 1;
  begin("POLYLINE", layer);
  entities_ += group(66, 1);  // its corners follow
  point(10, {0, 0});
  entities_ += group(70, kClosed);
  for (const Eigen::Vector2d& corner : corners) {
    begin("VERTEX", layer);
    point(10, corner);
  }
  begin("SEQEND", layer);
}

void DxfDrawing::add_circle(const std::string& layer, const Eigen::Vector2d& centre, double radius) {
  begin("CIRCLE", layer);
  point(10, centre);
  entities_ += length_group(40, radius);
}

void DxfDrawing::add_text(const std::string& layer, const Eigen::Vector2d& corner, double height,
                          const std::string& text) {
  begin("TEXT", layer);
  point(10, corner);
  entities_ += length_group(40, height) + group(1, ascii(text));
}

std::string DxfDrawing::text() const {
  return section("HEADER", header()) + section("TABLES", tables(layers_)) + section("BLOCKS", "") +
         section("ENTITIES", entities_) + group(0, "EOF");
}

}  // namespace drapeplan
