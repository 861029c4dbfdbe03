// What holds a floor up, in spans between grippers and in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "planner/reach/floor_nlp.hpp"

namespace drapeplan {
namespace {

constexpr double kLeastGain = 0.05;   // mm of the floor per mm of a span: a span below it holds nothing up
constexpr double kNegligible = 1e-4;  // [m]: finer than a ply is ever placed
/// Spans that add less than this to the gain of the first one are not told.
constexpr double kMinorShare = 0.1;
constexpr size_t kMostSpans = 3;
constexpr int kPieces = 4;  // of the mold's path under a cell: a chord of 5 mm is short by 2e-4 at R = 70 mm

/// The span that a cell belongs to: its grippers, or -1 beyond the last one.
struct SpanKey {
  bool weft = false;
  int from = -1, to = -1;
  auto operator<=>(const SpanKey&) const = default;
};

SpanKey span_of(const RigOptions& rig, const Eigen::Vector2d& middle, bool weft) {
  const Eigen::Vector2d at = (middle - rig.place(0)) / rig.spacing;  // in columns and rows
  const int along_count = weft ? rig.rows : rig.columns, across_count = weft ? rig.columns : rig.rows;
  const int across = std::clamp(int(std::lround(weft ? at.x() : at.y())), 0, across_count - 1);
  const int before = std::clamp(int(std::floor(weft ? at.y() : at.x())), -1, along_count - 1);
  const auto gripper = [&](int along) {
    if (along < 0 || along >= along_count) return -1;
    return weft ? along * rig.columns + across : across * rig.columns + along;
  };
  return {weft, gripper(before), gripper(before + 1)};
}

/// Length of the path on the mold below the straight way from a to b [m].
double path_below(const Mold& mold, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  double length = 0;
  Eigen::Vector3d last = mold.closest(a).foot;
  for (int k = 1; k <= kPieces; ++k) {
    const Eigen::Vector3d next = mold.closest(a + (b - a) * (double(k) / kPieces)).foot;
    length += (next - last).norm();
    last = next;
  }
  return length;
}

/// One line of cells along a span's fibres.
struct Line {
  double gain = 0, length = 0, path = 0;  ///< [-], [m], [m]
};

std::string millimetres(double length) {
  return fmt::format("{:.1f} mm", 1e3 * length);
}

std::string span_words(const RigOptions& rig, const TautSpan& span) {
  const std::string fibre = span.weft ? "the weft " : "the warp ";
  if (span.from >= 0 && span.to >= 0)
    return fibre + "between grippers " + rig.name(span.from) + " and " + rig.name(span.to);
  return fibre + "from gripper " + rig.name(std::max(span.from, span.to)) + " to the ply's edge";
}

}  // namespace

std::vector<TautSpan> taut_spans(const FloorProblem& problem, const std::vector<Fibre>& fibres,
                                 const std::vector<Eigen::Vector3d>& nodes,
                                 const Eigen::VectorXd& multipliers) {
  const double stretch = 1 + problem.fibre_strain;
  std::map<SpanKey, std::map<long, Line>> spans;  // lines by their place across, in micrometres
  for (size_t k = 0; k < fibres.size(); ++k) {
    const Fibre& cell = fibres[k];
    Eigen::Vector2d middle(0, 0);
    Eigen::Vector3d place(0, 0, 0), fibre(0, 0, 0);
    for (size_t c = 0; c < size_t(cell.count); ++c) {
      const auto node = size_t(cell.corner[c]);
      middle += problem.net.rest[node] / cell.count;
      place += nodes[node] / cell.count;
      fibre += cell.coefficient[c] * nodes[node];
    }
    const Eigen::Vector3d half = 0.5 * cell.length * fibre;
    const double across = cell.weft ? middle.x() : middle.y();
    Line& line = spans[span_of(problem.rig, middle, cell.weft)][std::lround(across * 1e6)];
    line.gain += std::max(0.0, multipliers[int(k)]) * stretch * cell.length;
    line.length += stretch * cell.length;
    line.path += path_below(problem.mold, place - half, place + half);
  }
  std::vector<TautSpan> all;
  for (const auto& [key, lines] : spans) {
    TautSpan span{key.weft, key.from, key.to};
    double most = -1;
    for (const auto& entry : lines) {
      const Line& line = entry.second;
      span.gain += line.gain / line.length;
      if (line.gain <= most) continue;
      most = line.gain;
      span.shortage = line.path - line.length;
    }
    all.push_back(span);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return all;
}

std::string front_table(const FloorFront& front) {
  std::string text =
      "smallest possible largest gap of the ply, by how far its edge may be off\n"
      "  edge within [mm]   gap [mm]   r.m.s. gap [mm]   edge off by [mm]\n";
  for (const FloorPoint& point : front.points) {
    const std::string within = std::isinf(point.boundary_tolerance)
                                   ? "anywhere"
                                   : fmt::format("{:g}", 1e3 * point.boundary_tolerance);
    text += fmt::format("  {:>16}", within);
    text += point.converged ? fmt::format("{:11.2f}{:18.2f}{:19.1f}\n", 1e3 * point.gap, 1e3 * point.rms_gap,
                                          1e3 * point.boundary_offset)
                            : fmt::format("   {}\n", point.status);
  }
  return text;
}

std::string explain_floor(const FloorProblem& problem, const FloorFront& front, double tolerance) {
  const FloorPoint* point = nullptr;
  for (const FloorPoint& one : front.points) {
    const double miss = std::abs(one.boundary_tolerance - tolerance);
    if (std::isinf(one.boundary_tolerance) ? point == nullptr
                                           : point == nullptr || std::isinf(point->boundary_tolerance) ||
                                                 miss < std::abs(point->boundary_tolerance - tolerance))
      point = &one;
  }
  if (point == nullptr) return "No boundary tolerance was asked for.";
  const std::string where = std::isinf(point->boundary_tolerance)
                                ? "Wherever its edge ends"
                                : fmt::format("With its edge within {} of the prescribed boundary",
                                              millimetres(point->boundary_tolerance));
  if (!point->converged)
    return fmt::format("{}, no floor of the ply's gap was found: {}.", where, point->status);
  if (point->gap <= kNegligible) return where + ", the ply can lie on the mold everywhere.";
  std::string text = fmt::format(
      "{}, a ply whose fibres stretch by {:.2g} % at most keeps a gap of {} somewhere, whatever the "
      "schedule.",
      where, 100 * problem.fibre_strain, millimetres(point->gap));
  size_t told = 0;
  for (const TautSpan& span : point->spans) {
    if (told == kMostSpans || span.gain < std::max(kLeastGain, kMinorShare * point->spans.front().gain))
      break;
    text += told == 0 ? " What holds it up most: " : "; ";
    text += span_words(problem.rig, span);
    if (span.shortage > kNegligible)
      text += fmt::format(" is {} too short for the mold below", millimetres(span.shortage));
    text += told == 0
                ? fmt::format(" (a millimetre more there would lower the floor by {:.1f} mm)", span.gain)
                : fmt::format(" ({:.1f})", span.gain);
    ++told;
  }
  text +=
      told > 0 ? "." : " No span of fibres holds it up: what is left stands at the rims of the rigid pads.";
  if (front.converged > 1 && front.start_spread > kNegligible)
    text += fmt::format(" The starts of the search disagree by up to {}: a lower floor may exist.",
                        millimetres(front.start_spread));
  return text;
}

}  // namespace drapeplan
