#include "planner/molds/height_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Places of a grid may be rounded by this share of the grid's size.
constexpr double kSamePlace = 1e-6;
// More crossings than this mean that points lie on no grid; each point then has lines of its own.
constexpr double kMostCrossingsPerPoint = 4;

struct Line {
  int number = 0;  ///< in the file, from 1
  std::vector<std::string_view> cells;
};

/// Heights at the crossings of a grid; NaN where there is none.
struct Grid {
  std::vector<double> x, y;  ///< increasing
  Eigen::MatrixXd z;         ///< (x, y)
};

/// Thrown inside this file only, and caught there.
struct Fault {
  int line = 0;
  std::string message;
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

/// The sign between columns: of all lines the first that has one.
char separator_of(std::string_view text) {
  for (const char candidate : {';', '\t', ','}) {
    if (text.find(candidate) != std::string_view::npos) return candidate;
  }
  return ' ';
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  if (separator != ' ') {
    for (size_t from = 0;;) {
      const size_t to = line.find(separator, from);
      cells.push_back(trimmed(line.substr(from, to - from)));
      if (to == std::string_view::npos) return cells;
      from = to + 1;
    }
  }
  for (size_t from = line.find_first_not_of(" \r"); from != std::string_view::npos;
       from = line.find_first_not_of(" \r", from)) {
    const size_t to = std::min(line.find_first_of(" \r", from), line.size());
    cells.push_back(line.substr(from, to - from));
    from = to;
  }
  return cells;
}

std::vector<Line> lines_of(std::string_view text) {
  const char separator = separator_of(text);
  std::vector<Line> lines;
  int number = 0;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line =
        trimmed(text.substr(0, end)).empty() ? std::string_view() : text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (!line.empty() && trimmed(line).front() != '#') lines.push_back({number, split(line, separator)});
  }
  return lines;
}

/// The number of a cell; NaN where it says that there is none; nothing where it is a word.
std::optional<double> number_of(std::string_view cell) {
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN") return kNaN;
  std::string text(cell);
  std::replace(text.begin(), text.end(), ',', '.');  // where commas separate, no cell has one
  const char* const first = text.data() + (text.front() == '+' ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

double number_at(const Line& line, size_t column) {
  const std::optional<double> value = number_of(line.cells[column]);
  if (!value)
    throw Fault{line.number,
                fmt::format("\"{}\" in column {} is no number", shown(line.cells[column]), column + 1)};
  return *value;
}

double place_at(const Line& line, size_t column, const char* what) {
  const double value = number_at(line, column);
  if (!std::isfinite(value))
    throw Fault{line.number, fmt::format("has no {} in column {}", what, column + 1)};
  return value;
}

void expect_cells(const Line& line, size_t count) {
  if (line.cells.size() != count)
    throw Fault{line.number,
                fmt::format("has {} columns, the lines before it have {}", line.cells.size(), count)};
}

/// Turned so that places increase.
void put_in_order(std::vector<double>& places, const char* name, int line) {
  if (places.size() < 2) throw Fault{line, fmt::format("the grid has fewer than two places along {}", name)};
  const bool falls = places.back() < places.front();
  for (size_t k = 1; k < places.size(); ++k) {
    if (falls ? !(places[k] < places[k - 1]) : !(places[k] > places[k - 1]))
      throw Fault{
          line, fmt::format("places along {} are not in order: {} after {}", name, places[k], places[k - 1])};
  }
}

void turn_upwards(Grid& grid) {
  if (grid.x.back() < grid.x.front()) {
    std::reverse(grid.x.begin(), grid.x.end());
    grid.z = grid.z.colwise().reverse().eval();
  }
  if (grid.y.back() < grid.y.front()) {
    std::reverse(grid.y.begin(), grid.y.end());
    grid.z = grid.z.rowwise().reverse().eval();
  }
}

bool is_esri(const std::vector<Line>& lines) {
  std::string word(lines.front().cells.front());
  for (char& letter : word) letter = char(std::tolower(static_cast<unsigned char>(letter)));
  return word == "ncols" || word == "nrows";
}

Grid esri_grid(const std::vector<Line>& lines) {
  std::map<std::string, double> header;
  size_t at = 0;
  for (; at < lines.size() && !number_of(lines[at].cells.front()); ++at) {
    const Line& line = lines[at];
    std::string key(line.cells.front());
    for (char& letter : key) letter = char(std::tolower(static_cast<unsigned char>(letter)));
    if (line.cells.size() != 2)
      throw Fault{line.number, fmt::format("expected one number behind \"{}\"", shown(key))};
    header[key] = number_at(line, 1);
  }
  const auto value = [&](const std::string& key) {
    if (!header.contains(key))
      throw Fault{lines.front().number, fmt::format("the grid's header has no {}", key)};
    return header.at(key);
  };
  const double columns = value("ncols"), rows = value("nrows"), size = value("cellsize");
  if (!(columns >= 2 && rows >= 2 && size > 0) || double(lines.size() - at) != rows)
    throw Fault{lines.front().number,
                fmt::format("a grid of {} columns and {} rows with cells of {}, and {} rows follow", columns,
                            rows, size, lines.size() - at)};
  const double x = header.contains("xllcenter") ? header.at("xllcenter") : value("xllcorner") + 0.5 * size;
  const double y = header.contains("yllcenter") ? header.at("yllcenter") : value("yllcorner") + 0.5 * size;
  Grid grid;
  for (int i = 0; i < int(columns); ++i) grid.x.push_back(x + i * size);
  for (int j = 0; j < int(rows); ++j) grid.y.push_back(y + j * size);
  grid.z.resize(int(columns), int(rows));
  for (int j = 0; j < int(rows); ++j) {
    const Line& line = lines[at + size_t(j)];
    expect_cells(line, size_t(columns));
    for (int i = 0; i < int(columns); ++i) {
      const double z = number_at(line, size_t(i));
      const bool none = header.contains("nodata_value") && z == header.at("nodata_value");
      grid.z(i, int(rows) - 1 - j) = none ? kNaN : z;
    }
  }
  return grid;
}

/// A row of x, with or without a word in front, then rows of y and heights.
Grid matrix(const std::vector<Line>& lines) {
  const Line& head = lines.front();
  if (lines.size() < 3) throw Fault{head.number, "a matrix has a row of x and at least two rows of heights"};
  const size_t width = lines[1].cells.size();
  const size_t skip = head.cells.size() == width ? 1 : 0;
  if (head.cells.size() + 1 != width + skip)
    throw Fault{head.number,
                fmt::format("has {} places of x, and line {} has {} columns: y and a height for each x",
                            head.cells.size(), lines[1].number, width)};
  Grid grid;
  for (size_t k = skip; k < head.cells.size(); ++k) grid.x.push_back(place_at(head, k, "x"));
  grid.z.resize(int(grid.x.size()), int(lines.size()) - 1);
  for (size_t row = 1; row < lines.size(); ++row) {
    expect_cells(lines[row], width);
    grid.y.push_back(place_at(lines[row], 0, "y"));
    for (size_t k = 1; k < width; ++k) grid.z(int(k) - 1, int(row) - 1) = number_at(lines[row], k);
  }
  put_in_order(grid.x, "x", head.number);
  put_in_order(grid.y, "y", lines[1].number);
  turn_upwards(grid);
  return grid;
}

/// Places that differ by rounding only are one.
std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double same = kSamePlace * (values.back() - values.front());
  std::vector<double> kept;
  for (const double value : values) {
    if (kept.empty() || value - kept.back() > same) kept.push_back(value);
  }
  return kept;
}

int index_of(const std::vector<double>& places, double place) {
  const double same = kSamePlace * (places.back() - places.front());
  return int(std::upper_bound(places.begin(), places.end(), place + same) - places.begin()) - 1;
}

/// Rows x, y, z in any order, on a grid.
Grid grid_of_points(const std::vector<Line>& lines) {
  const size_t first = number_of(lines.front().cells.front()) ? 0 : 1;  // a row of names
  std::vector<double> x, y, z;
  for (size_t k = first; k < lines.size(); ++k) {
    expect_cells(lines[k], 3);
    x.push_back(place_at(lines[k], 0, "x"));
    y.push_back(place_at(lines[k], 1, "y"));
    z.push_back(number_at(lines[k], 2));
  }
  if (x.empty()) throw Fault{lines.front().number, "has no rows of numbers"};
  Grid grid{distinct(x), distinct(y), {}};
  put_in_order(grid.x, "x", lines[first].number);
  put_in_order(grid.y, "y", lines[first].number);
  const double crossings = double(grid.x.size()) * double(grid.y.size());
  if (crossings > kMostCrossingsPerPoint * double(x.size()))
    throw Fault{
        lines[first].number,
        fmt::format("{} points have {} different x and {} different y: they lie on no rectangular grid. Make "
                    "triangles of scattered points (STL, OBJ)",
                    x.size(), grid.x.size(), grid.y.size())};
  grid.z = Eigen::MatrixXd::Constant(int(grid.x.size()), int(grid.y.size()), kNaN);
  for (size_t k = 0; k < x.size(); ++k) {
    double& height = grid.z(index_of(grid.x, x[k]), index_of(grid.y, y[k]));
    if (std::isfinite(height) && height != z[k])
      throw Fault{lines[first + k].number,
                  fmt::format("a second height at x = {}, y = {}: {} after {}", x[k], y[k], z[k], height)};
    height = z[k];
  }
  return grid;
}

Triangles triangles_of(const Grid& grid) {
  Triangles triangles;
  Eigen::MatrixXi index = Eigen::MatrixXi::Constant(grid.z.rows(), grid.z.cols(), -1);
  for (int i = 0; i < grid.z.rows(); ++i) {
    for (int j = 0; j < grid.z.cols(); ++j) {
      if (!std::isfinite(grid.z(i, j))) continue;
      index(i, j) = int(triangles.vertices.size());
      triangles.vertices.emplace_back(grid.x[size_t(i)], grid.y[size_t(j)], grid.z(i, j));
    }
  }
  for (int i = 0; i + 1 < grid.z.rows(); ++i) {
    for (int j = 0; j + 1 < grid.z.cols(); ++j) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      if (std::min({a, b, c, d}) < 0) continue;
      triangles.corners.push_back({a, b, c});
      triangles.corners.push_back({a, c, d});
    }
  }
  return triangles;
}

Grid grid_of(const std::vector<Line>& lines) {
  if (lines.empty()) throw Fault{0, "is empty"};
  if (is_esri(lines)) return esri_grid(lines);
  const bool points = lines.size() > 1 && lines[1].cells.size() == 3 && lines[0].cells.size() == 3;
  return points ? grid_of_points(lines) : matrix(lines);
}

}  // namespace

TriangleReading read_heights(const std::filesystem::path& file) {
  TriangleReading reading;
  const FileText content = read_file(file);
  if (!content.fault.empty()) {
    reading.errors.push_back({file.string(), 0, "", "cannot be read: " + content.fault});
    return reading;
  }
  try {
    reading.triangles = triangles_of(grid_of(lines_of(content.text)));
    if (reading.triangles.corners.empty())
      throw Fault{0, "no rectangle of the grid has heights at all its corners"};
  } catch (const Fault& fault) {
    reading.errors.push_back({file.string(), fault.line, "", fault.message});
  }
  return reading;
}

}  // namespace drapeplan
