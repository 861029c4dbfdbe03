#include "planner/report/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/report/svg.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

constexpr double kStill = 1e-6;  // a stroke shorter than this is none [m]

/// Range of one axis and the length it is drawn with. On a logarithmic axis range and steps are of the
/// decimal logarithm.
struct Axis {
  double from = 0, to = 1, step = 0.2;
  double start = 0, length = 1;  ///< [px]; length < 0: upwards
  bool logarithmic = false;

  /// Place of a value, which is > 0 on a logarithmic axis [px].
  [[nodiscard]] double at(double value) const { return along(logarithmic ? std::log10(value) : value); }
  /// Place of a multiple of the step [px].
  [[nodiscard]] double along(double tick) const { return start + length * (tick - from) / (to - from); }
  [[nodiscard]] int ticks() const { return int(std::lround((to - from) / step)); }
  [[nodiscard]] double tick(int k) const { return from + k * step; }
  [[nodiscard]] std::string label(int k) const {
    if (!logarithmic) return fixed(tick(k), decimals_of(step));
    const double value = std::pow(10.0, tick(k));
    return fixed(value, std::max(0, int(std::ceil(-tick(k) - 1e-9))) +
                            (std::abs(std::remainder(tick(k), 1)) > 0.01 ? 1 : 0));
  }
};

/// Round limits around the values; starts at zero if that costs less than half of the axis.
Axis round_axis(double smallest, double largest, double start, double length) {
  if (!(smallest <= largest)) smallest = 0, largest = 1;
  if (smallest > 0 && smallest < 0.5 * largest) smallest = 0;
  if (smallest == largest)
    smallest -= 0.5 * std::max(1.0, std::abs(smallest)), largest += 0.5 * std::max(1.0, std::abs(largest));
  Axis axis{0, 1, nice_step(largest - smallest, 6), start, length};
  axis.from = std::floor(smallest / axis.step + 1e-9) * axis.step;
  axis.to = std::ceil(largest / axis.step - 1e-9) * axis.step;
  return axis;
}

/// Whole decades around the values, which are > 0; halves of decades if they span less than one and a half.
Axis decades(double smallest, double largest, double start, double length) {
  if (!(smallest <= largest) || !(smallest > 0)) smallest = 0.1, largest = 1;
  const double low = std::log10(smallest), high = std::log10(largest);
  const double step = high - low < 1.5 ? 0.5 : high - low < 6 ? 1 : 2;
  Axis axis{
      std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step, start, length, true};
  if (!(axis.to > axis.from)) axis.to = axis.from + step;
  return axis;
}

/// The paper of a plot, with what is drawn on it; its colours stay as they are where a page is dark. Points
/// on its limits are seen whole. @param draw  is called with the axes as they are inside.
template <class Draw>
void draw_paper(Svg& svg, Axis x, Axis y, const Draw& draw) {
  constexpr double kRim = 7;  // [px]
  const Vector2d corner(x.start - kRim, y.start + y.length - kRim);
  const Vector2d size(x.length + 2 * kRim, 2 * kRim - y.length);
  svg.open_window(corner, size);
  svg.rectangle({0, 0}, size, {.fill = ink::kSurface});
  x.start -= corner.x();
  y.start -= corner.y();
  draw(x, y);
  svg.close_window();
}

void draw_axes(Svg& svg, const Axis& x, const Axis& y, const std::string& x_label,
               const std::string& y_label) {
  const Svg::TextStyle tick{.size = 11, .anchor = Svg::Anchor::middle, .colour = ink::kSoft};
  Svg::TextStyle left = tick;
  left.anchor = Svg::Anchor::end;
  const double x_end = x.start + x.length;
  for (int k = 0; k <= y.ticks(); ++k) {
    svg.text({x.start - 12, y.along(y.tick(k)) + 4}, y.label(k), left);
  }
  for (int k = 0; k <= x.ticks(); ++k) {
    const double place = x.along(x.tick(k));
    svg.line({place, y.start + 7}, {place, y.start + 11}, {.stroke = ink::kSoft});
    svg.text({place, y.start + 24}, x.label(k), tick);
  }
  svg.text({x_end, y.start + 41}, x_label, {.size = 12, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  svg.text({x.start - 44, y.start + y.length - 12}, y_label, {.size = 12, .colour = ink::kSoft});
}

/// Hues that stay apart for colour-blind readers (Okabe and Ito, 2008; then P. Tol's muted scheme); many
/// series without a list of names beside the chart take the sequential colours.
std::string series_colour(const Chart& chart, size_t number) {
  static constexpr std::array kHues{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                    "#56b4e9", "#332288", "#882255", "#999933", "#117733",
                                    "#44aa99", "#5b6775", "#1d2733"};
  constexpr size_t kFew = 6;
  if (const auto shade = chart.series[number].shade) return sequential_colour(*shade);
  const size_t count = chart.series.size();
  if (chart.side_legend || count <= kFew) return kHues[number % kHues.size()];
  return sequential_colour(0.25 + 0.75 * double(number) / double(count - 1));
}

/// The points that can be drawn: finite, and > 0 along logarithmic axes.
std::vector<Vector2d> drawn_points(const Chart& chart, const ChartSeries& series) {
  std::vector<Vector2d> points;
  for (const Vector2d& p : series.points) {
    if (!p.allFinite() || (chart.log_x && !(p.x() > 0)) || (chart.log_y && !(p.y() > 0))) continue;
    if (series.steps && !points.empty()) points.emplace_back(p.x(), points.back().y());
    points.push_back(p);
  }
  return points;
}

void draw_grid_lines(Svg& svg, const Axis& x, const Axis& y) {
  for (int k = 0; k <= y.ticks(); ++k) {
    const double place = y.along(y.tick(k));
    svg.line({x.start, place}, {x.start + x.length, place}, {.stroke = k == 0 ? ink::kSoft : ink::kGrid});
  }
}

void draw_series(Svg& svg, const Axis& x, const Axis& y, const Chart& chart, size_t number) {
  const ChartSeries& series = chart.series[number];
  const std::string colour = series_colour(chart, number);
  std::vector<Vector2d> places;
  for (const Vector2d& p : drawn_points(chart, series)) places.emplace_back(x.at(p.x()), y.at(p.y()));
  if (!series.dots) svg.polyline(places, {.stroke = colour, .width = 1.8});
  if (series.rings) {
    for (const Vector2d& place : places) svg.circle(place, 6, {.stroke = colour, .width = 1.6});
  } else if (series.dots || series.marks) {
    const double radius = series.marks ? 3 : 2.2;
    for (const Vector2d& place : places)
      svg.circle(place, radius, {.fill = colour, .opacity = series.marks ? 1 : 0.6});
  }
}

/// From the right; what would cover the label of y goes a row up.
void draw_top_legend(Svg& svg, const Chart& chart, double right, double left) {
  double legend = right, base = 48;
  for (size_t k = chart.series.size(); k-- > 0;) {
    const ChartSeries& series = chart.series[k];
    if (series.name.empty()) continue;
    constexpr double kDot = 10, kRow = 18;  // a dot and its distance; height of a row
    const double wide = kDot + text_width(series.name, 12);
    if (legend - wide < left) legend = right, base -= kRow;
    svg.text({legend - wide + kDot, base}, series.name, {.size = 12, .colour = ink::kSoft});
    svg.circle({legend - wide, base - 4}, 4, {.fill = series_colour(chart, k)});
    legend -= wide + 18;
  }
}

/// Width of the longest name of a chart's series [px].
double widest_name(const Chart& chart) {
  double widest = 0;
  for (const ChartSeries& series : chart.series) widest = std::max(widest, text_width(series.name, 12));
  return widest;
}

/// One name per row, downwards, on paper of its own.
void draw_side_legend(Svg& svg, const Chart& chart, const Vector2d& corner) {
  constexpr double kRow = 20, kRim = 12;
  const auto names = std::count_if(chart.series.begin(), chart.series.end(),
                                   [](const ChartSeries& series) { return !series.name.empty(); });
  const Vector2d size(3 * kRim + widest_name(chart), kRow * double(names) + kRim);
  svg.open_window(corner, size);
  svg.rectangle({0, 0}, size, {.fill = ink::kSurface});
  double base = kRow;
  for (size_t k = 0; k < chart.series.size(); ++k) {
    const ChartSeries& series = chart.series[k];
    if (series.name.empty()) continue;
    const std::string colour = series_colour(chart, k);
    if (series.rings)
      svg.circle({kRim, base - 4}, 5, {.stroke = colour, .width = 1.6});
    else
      svg.circle({kRim, base - 4}, 4, {.fill = colour});
    svg.text({2 * kRim, base}, series.name, {.size = 12, .colour = ink::kSoft});
    base += kRow;
  }
  svg.close_window();
}

/// What a gripper does, in the schedule's time.
struct Stroke {
  double start = 0, end = 0;  ///< [s], blending included
  double travel = 0;          ///< [m], down < 0
};

/// Movements without rest between them are one stroke as long as they go the same way.
std::vector<Stroke> strokes(const std::vector<Knot>& path, double blend) {
  std::vector<Stroke> result;
  bool moving = false;
  for (size_t k = 1; k < path.size(); ++k) {
    const double travel = path[k].z - path[k - 1].z;
    if (std::abs(travel) < kStill) {
      moving = false;
    } else if (moving && travel * result.back().travel > 0) {
      result.back().end = path[k].time + blend;
      result.back().travel += travel;
    } else {
      result.push_back({path[k - 1].time, path[k].time + blend, travel});
      moving = true;
    }
  }
  return result;
}

/// Everything that the picture of a sequence needs of one gripper.
struct Row {
  int gripper = 0;
  std::vector<Stroke> strokes;
  int descent = -1;  ///< the last stroke down among the strokes, -1: none
  [[nodiscard]] double start() const { return descent < 0 ? 0 : strokes[size_t(descent)].start; }
  [[nodiscard]] double arrival() const { return descent < 0 ? 0 : strokes[size_t(descent)].end; }
};

std::vector<Row> sequence(const Schedule& schedule) {
  std::vector<Row> rows;
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    Row row{int(g), strokes(schedule.paths[g], schedule.blend_time), -1};
    for (size_t k = 0; k < row.strokes.size(); ++k) {
      if (row.strokes[k].travel < 0) row.descent = int(k);
    }
    rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.arrival(), a.start()) < std::pair(b.arrival(), b.start());
  });
  return rows;
}

/// Share of a gripper's arrival between the first and the last one: its colour.
class ArrivalScale {
 public:
  explicit ArrivalScale(const std::vector<Row>& rows)
      : first_(rows.front().arrival()), last_(rows.back().arrival()) {}
  [[nodiscard]] double share(double arrival) const {
    return last_ - first_ > 1e-9 ? 0.2 + 0.75 * (arrival - first_) / (last_ - first_) : 0.6;
  }
  [[nodiscard]] std::string colour(double arrival) const { return sequential_colour(share(arrival)); }
  [[nodiscard]] std::string text_colour(double arrival) const {
    return share(arrival) > 0.45 ? "#ffffff" : ink::kText;
  }

 private:
  double first_, last_;
};

void draw_bars(Svg& svg, const std::vector<Row>& rows, const Axis& x, double top, double pitch) {
  const ArrivalScale scale(rows);
  for (size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    const double y = top + double(r) * pitch;
    for (size_t k = 0; k < row.strokes.size(); ++k) {
      const Stroke& stroke = row.strokes[k];
      const double from = x.at(stroke.start), width = std::max(1.0, x.at(stroke.end) - from);
      const bool descent = int(k) == row.descent;
      svg.rectangle({from, y + 2}, {width, pitch - 4},
                    {.fill = descent ? scale.colour(stroke.end) : "#d4dae1"}, 2.5);
      constexpr double kRoomForText = 70;
      if (width < kRoomForText) continue;
      const std::string travel = fmt::format("{} {} mm", stroke.travel < 0 ? "\u2193" : "\u2191",
                                             fixed(1000 * std::abs(stroke.travel), 0));
      svg.text({from + 0.5 * width, y + 0.5 * pitch + 3.5}, travel,
               {.size = 10,
                .anchor = Svg::Anchor::middle,
                .colour = descent ? scale.text_colour(stroke.end) : ink::kSoft});
    }
  }
}

void draw_grid(Svg& svg, const std::vector<Row>& rows, const RigOptions& rig, const Vector2d& corner,
               double cell) {
  const ArrivalScale scale(rows);
  svg.text(corner - Vector2d(0, 12), "arrival from above [s]", {.size = 12, .colour = ink::kSoft});
  const Vector2d size = cell * Vector2d(rig.columns, rig.rows);
  svg.open_window(corner, size);
  svg.rectangle({0, 0}, size, {.fill = ink::kSurface});
  for (const Row& row : rows) {
    const int i = row.gripper % rig.columns, j = row.gripper / rig.columns;
    const Vector2d centre = cell * Vector2d(i + 0.5, rig.rows - j - 0.5);
    svg.circle(centre, 0.42 * cell,
               {.fill = scale.colour(row.arrival()), .stroke = ink::kSoft, .width = 0.6});
    svg.text(centre + Vector2d(0, 4), fixed(row.arrival(), 1),
             {.size = 11, .anchor = Svg::Anchor::middle, .colour = scale.text_colour(row.arrival())});
  }
  svg.close_window();
  for (int i = 0; i < rig.columns; ++i) {
    svg.text(corner + cell * Vector2d(i + 0.5, rig.rows) + Vector2d(0, 14), fmt::to_string(i + 1),
             {.size = 10, .anchor = Svg::Anchor::middle, .colour = ink::kSoft});
  }
  for (int j = 0; j < rig.rows; ++j) {
    svg.text(corner + cell * Vector2d(0, rig.rows - j - 0.5) + Vector2d(-6, 4), fmt::to_string(j + 1),
             {.size = 10, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  }
}

}  // namespace

std::string line_chart(const Chart& chart) {
  constexpr double kLeft = 62, kRight = 24, kSideLegend = 190, kTop = 66, kBottom = 52;
  const double infinity = std::numeric_limits<double>::infinity();
  Vector2d smallest(infinity, infinity), largest = -smallest;
  for (const ChartSeries& series : chart.series) {
    for (const Vector2d& p : drawn_points(chart, series)) {
      smallest = smallest.cwiseMin(p);
      largest = largest.cwiseMax(p);
    }
  }
  const auto axis_of = [](bool logarithmic) { return logarithmic ? decades : round_axis; };
  const double right = chart.side_legend ? kSideLegend : kRight;
  const double beside = chart.side_legend ? std::max(0.0, 60 + widest_name(chart) - kSideLegend) : 0;
  const Axis x = axis_of(chart.log_x)(smallest.x(), largest.x(), kLeft, chart.width - kLeft - right);
  const Axis y = axis_of(chart.log_y)(smallest.y(), largest.y(), chart.height - kBottom,
                                      -(chart.height - kTop - kBottom));
  Svg svg(chart.width + beside, chart.height, chart.title);
  svg.text({18, 26}, chart.title, {.size = 15, .bold = true});
  draw_axes(svg, x, y, chart.x_label, chart.y_label);
  draw_paper(svg, x, y, [&](const Axis& across, const Axis& up) {
    draw_grid_lines(svg, across, up);
    for (size_t k = 0; k < chart.series.size(); ++k) draw_series(svg, across, up, chart, k);
  });
  if (chart.side_legend) {
    draw_side_legend(svg, chart, {chart.width - right + 16, kTop - 7});
  } else {
    draw_top_legend(svg, chart, chart.width - kRight, 2 * kLeft);
  }
  return svg.finish();
}

Chart height_chart(const Schedule& schedule, const RigOptions& rig, const std::string& title) {
  constexpr int kSamples = 200;
  Chart chart{title, "time [s]", "joint height [mm]", {}};
  const std::vector<Row> rows = sequence(schedule);
  for (const Row& row : rows) {
    const auto g = size_t(row.gripper);
    ChartSeries series{.name = schedule.paths.size() <= 6 ? rig.name(row.gripper) : "",
                       .points = {},
                       .shade = ArrivalScale(rows).share(row.arrival())};
    for (int k = 0; k <= kSamples; ++k) {
      const double time = schedule.duration() * k / kSamples;
      series.points.emplace_back(time, 1000 * schedule.command(int(g), time).z);
    }
    chart.series.push_back(series);
  }
  return chart;
}

std::string schedule_picture(const Schedule& schedule, const RigOptions& rig, const std::string& title) {
  if (rig.count() < 1 || int(schedule.paths.size()) != rig.count()) {
    throw std::invalid_argument(
        fmt::format("schedule_picture: {} paths for {} grippers", schedule.paths.size(), rig.count()));
  }
  constexpr double kLeft = 62, kTop = 74, kPitch = 18, kBars = 560, kGap = 60, kCell = 38;
  const std::vector<Row> rows = sequence(schedule);
  const double grid_height = kCell * rig.rows + 20;
  const double height = std::max(kPitch * double(rows.size()), grid_height);
  Axis x = round_axis(0, std::max(schedule.duration(), 1e-3), kLeft, kBars);
  Svg svg(kLeft + kBars + kGap + kCell * rig.columns + 24, kTop + height + 56, title);
  svg.text({18, 26}, title, {.size = 15, .bold = true});
  svg.text({18, 46}, "strokes of the grippers [i, j] in order of arrival; grey: before the last descent",
           {.size = 12, .colour = ink::kSoft});
  const double length = kPitch * double(rows.size()), bottom = kTop + length;
  draw_paper(svg, x, {.start = bottom, .length = -length}, [&](const Axis& across, const Axis& up) {
    for (int k = 0; k <= x.ticks(); ++k) {
      const double place = across.along(x.tick(k));
      svg.line({place, up.start}, {place, up.start - length}, {.stroke = ink::kGrid});
    }
    draw_bars(svg, rows, across, up.start - length, kPitch);
  });
  for (int k = 0; k <= x.ticks(); ++k) {
    svg.text({x.along(x.tick(k)), bottom + 24}, x.label(k),
             {.size = 11, .anchor = Svg::Anchor::middle, .colour = ink::kSoft});
  }
  for (size_t r = 0; r < rows.size(); ++r) {
    svg.text({x.start - 12, kTop + (double(r) + 0.5) * kPitch + 4}, rig.name(rows[r].gripper),
             {.size = 11, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  }
  svg.text({kLeft + kBars, bottom + 42}, "time [s]",
           {.size = 12, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  draw_grid(svg, rows, rig, {kLeft + kBars + kGap, kTop}, kCell);
  return svg.finish();
}

}  // namespace drapeplan
