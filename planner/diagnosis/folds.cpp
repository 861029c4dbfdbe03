#include "planner/diagnosis/folds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "planner/diagnosis/nearest.hpp"
#include "planner/drape/acceptance.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Of two folds that are nearer to each other than this share of the spacing only the higher one counts.
constexpr double kApart = 0.5;
/// A fold reaches along its fibre to where the ply is lower than this share of its height, or rises again by
/// the other one above the lowest place on the way.
constexpr double kFoot = 0.1, kRise = 0.05;
/// What lies nearer to a pad's centre than this many radii lies at its rim.
constexpr double kRim = 1.5;
/// Shear of the ply beside a pad, whose own piece cannot shear, from which a fold at the rim is laid to it:
/// over the radius of a pad it displaces the ply by a tenth of that radius.
constexpr double kRimShearDeg = 6;
constexpr double kDegrees = 180 / std::numbers::pi;

/// The later one of two instants; NaN, which is never, is later than all.
double later(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? kNaN : std::max(a, b);
}

class FoldFinder {
 public:
  FoldFinder(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity)
      : case_(problem.definition()),
        rig_(*case_.grippers),
        drape_(drape),
        mesh_(problem.model(fidelity).scene().mesh),
        mold_(*case_.mold),
        lines_(mesh_),
        bridges_(bridging(mesh_, drape.run.final, mold_)),
        around_(mesh_.rest.size()) {
    for (const Eigen::Vector3d& place : drape.run.final.position) feet_.push_back(mold_.closest(place).foot);
    for (int g = 0; g < rig_.count(); ++g) pads_.push_back(nearest_node(mesh_, rig_.place(g)));
    for (const auto& quad : mesh_.quads) {
      for (const int node : quad)
        around_[size_t(node)].insert(around_[size_t(node)].end(), quad.begin(), quad.end());
    }
    if (drape.frames.empty() || drape.frames.front().time > 0) return;  // nobody looked from the start on
    for (const Snapshot& frame : drape.frames) instants_.push_back(&frame);
    if (drape.frames.back().time < drape.run.final.time) instants_.push_back(&drape.run.final);
  }

  std::vector<Fold> find() const {
    std::vector<Fold> folds;
    std::vector<int> order;
    for (int node = 0; node < mesh_.node_count(); ++node) {
      if (gap(node) > case_.score.target_gap && is_peak(node)) order.push_back(node);
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return gap(a) > gap(b); });
    for (const int node : order) {
      if (int(folds.size()) == kMostFolds) break;
      const bool apart = std::all_of(folds.begin(), folds.end(), [&](const Fold& fold) {
        return (fold.at - mesh_.rest[size_t(node)]).norm() >= kApart * rig_.spacing;
      });
      if (apart) folds.push_back(fold_at(node));
    }
    return folds;
  }

 private:
  struct Instants {
    double before = kNaN, since = kNaN;
  };

  [[nodiscard]] double gap(int node) const { return drape_.gap[size_t(node)]; }
  [[nodiscard]] double pad_gap(int gripper) const { return gap(pads_[size_t(gripper)]); }

  /// No node of its elements is higher: a slope of a higher fold is no fold of its own.
  [[nodiscard]] bool is_peak(int node) const {
    const std::vector<int>& around = around_[size_t(node)];
    return std::none_of(around.begin(), around.end(), [&](int other) { return gap(other) > gap(node); });
  }

  [[nodiscard]] bool released(int gripper) const {
    const std::vector<PadState>& pads = drape_.run.state.pads;
    return size_t(gripper) < pads.size() && pads[size_t(gripper)].released;
  }

  /// The grippers on both sides of a place along a fibre, where there are some: of the nearest row the
  /// nearest one. A gripper that is beside the place, across the fibre, is on neither side.
  [[nodiscard]] std::vector<int> beside(const Eigen::Vector2d& at, Fibre fibre) const {
    const int along = fibre == Fibre::warp ? 0 : 1, across = 1 - along;
    std::vector<int> found;
    for (const double side : {-1.0, 1.0}) {
      int nearest = -1;
      const auto off = [&](int g) { return (rig_.place(g) - at).eval(); };
      for (int g = 0; g < rig_.count(); ++g) {
        const double way = side * off(g)[along], aside = std::abs(off(g)[across]);
        if (way <= 0 || (way < rig_.pad_radius && aside > rig_.pad_radius)) continue;
        if (nearest < 0 || off(g).norm() < off(nearest).norm()) nearest = g;
      }
      if (nearest >= 0) found.push_back(nearest);
    }
    if (found.empty()) found.push_back(nearest_gripper(rig_, at));
    return found;
  }

  /// From valley to valley, or from where the ply is low.
  [[nodiscard]] FibreSpan span_of(int node, Fibre fibre) const {
    const double low = kFoot * gap(node), rise = kRise * gap(node);
    const auto goes_on = [&](const std::vector<int>& way, int to) {
      double lowest = gap(to);
      for (const int on : way) lowest = std::min(lowest, gap(on));
      return gap(way.back()) > low && gap(to) <= lowest + rise;
    };
    return lines_.span(node, fibre, goes_on, drape_.run.final.position, feet_);
  }

  /// The first instant from which on `holds` is true to the end, and the one before it.
  template <class Holds>
  [[nodiscard]] Instants from_when(const Holds& holds) const {
    Instants found;
    for (auto frame = instants_.rbegin(); frame != instants_.rend(); ++frame) {
      found.before = (*frame)->time;
      if (!holds(**frame)) break;
      found.since = (*frame)->time;
    }
    return found;
  }

  [[nodiscard]] double gap_in(const Snapshot& frame, int node) const {
    return std::max(signed_gap(frame.position[size_t(node)], mold_, case_.material.thickness), 0.0);
  }

  /// When a node came down to `height` for good [s].
  [[nodiscard]] double down(int node, double height) const {
    return from_when([&](const Snapshot& frame) { return gap_in(frame, node) <= height; }).since;
  }

  /// An end of a span is at the ply's edge and as good as not lower: nothing supports it there.
  [[nodiscard]] bool is_free(const FibreSpan& span) const {
    double highest = 0;
    for (const int node : span.nodes) highest = std::max(highest, gap(node));
    const auto high = [&](int end) { return gap(end) > kHeldShare * highest; };
    return (span.from_edge && high(span.nodes.front())) || (span.to_edge && high(span.nodes.back()));
  }

  /// Largest shear of the elements at the rim of a pad [deg].
  [[nodiscard]] double rim_shear(int gripper) const {
    double largest = 0;
    for (size_t e = 0; e < mesh_.quads.size(); ++e) {
      Eigen::Vector2d centre(0, 0);
      for (const int corner : mesh_.quads[e]) centre += mesh_.rest[size_t(corner)] / 4;
      if ((centre - rig_.place(gripper)).norm() < kRim * rig_.pad_radius)
        largest = std::max(largest, kDegrees * std::abs(drape_.run.final.shear[e]));
    }
    return largest;
  }

  /// Of the mold below a span, along it [1/m].
  [[nodiscard]] double curvature_below(const FibreSpan& span) const {
    const Eigen::Vector3d &first = feet_[size_t(span.nodes.front())],
                          &last = feet_[size_t(span.nodes.back())];
    const Eigen::Vector3d& middle = feet_[size_t(span.nodes[span.nodes.size() / 2])];
    return mold_.normal_curvature(middle.x(), middle.y(), (last - first).head<2>());
  }

  [[nodiscard]] Fold fold_at(int node) const {
    Fold fold;
    fold.node = node;
    fold.at = mesh_.rest[size_t(node)];
    fold.height = gap(node);
    const FibreSpan warp = span_of(node, Fibre::warp), weft = span_of(node, Fibre::weft);
    const bool warp_more = warp.slack() >= weft.slack();
    const FibreSpan &more = warp_more ? warp : weft, &less = warp_more ? weft : warp;
    // There is too little ply where a fibre is taut, or where one lacks more than the other one has too much.
    const bool chord = (bridges_[size_t(node)] || -less.slack() > more.slack()) && !is_free(less);
    fold.fibre = chord == warp_more ? Fibre::weft : Fibre::warp;
    const FibreSpan& span = chord ? less : more;
    fold.span = span.below;
    fold.slack = span.slack();
    fold.arch = arch_height(fold.slack, fold.span, curvature_below(span));
    fold.grippers = beside(fold.at, fold.fibre);
    const int nearest = nearest_gripper(rig_, fold.at);
    const double distance = (rig_.place(nearest) - fold.at).norm();
    const bool held_up = !released(nearest) && pad_gap(nearest) >= kHeldShare * fold.height;
    if (chord) {
      fold.kind = FoldKind::bridging;
    } else if ((is_free(warp) || is_free(weft)) && distance > rig_.pad_radius && !held_up) {
      fold.kind = FoldKind::edge;
      fold.grippers = {nearest};
    } else if (held_up) {
      fold.kind = FoldKind::held_up;
      fold.grippers = {nearest};
    } else if (distance < kRim * rig_.pad_radius && rim_shear(nearest) > kRimShearDeg) {
      fold.kind = FoldKind::pad_rim;
      fold.grippers = {nearest};
    }
    look_at_times(span, fold);
    look_at_grippers(fold);
    // Both sides of the arch lay on the mold before the pads did: they were not what pushed it up.
    const bool before_pads =
        std::isnan(fold.down) ? !std::isnan(fold.sides_down) : fold.sides_down < fold.down;
    if (fold.kind == FoldKind::slack && before_pads) fold.kind = FoldKind::stall;
    return fold;
  }

  void look_at_times(const FibreSpan& span, Fold& fold) const {
    const double near = std::max(kSettled * fold.height, case_.score.target_gap), low = kFoot * fold.height;
    const Instants stands = from_when(
        [&](const Snapshot& frame) { return std::abs(gap_in(frame, fold.node) - fold.height) <= near; });
    fold.before = stands.before;
    fold.since = stands.since;
    const double sides = std::max({low, gap(span.nodes.front()), gap(span.nodes.back())});
    fold.sides_down = later(down(span.nodes.front(), sides), down(span.nodes.back(), sides));
    fold.down = 0;
    for (const int g : fold.grippers)
      fold.down = later(fold.down, down(pads_[size_t(g)], case_.score.target_gap));
  }

  void look_at_grippers(Fold& fold) const {
    const std::vector<double>& force = drape_.run.final.actuator_force;
    for (const int g : fold.grippers) {
      if (released(g)) continue;
      fold.pad_gap = std::max(fold.pad_gap, pad_gap(g));
      if (size_t(g) < force.size() && std::abs(force[size_t(g)]) >= kFull * rig_.actuator_force_limit)
        fold.saturated = true;
    }
  }

  /// An actuator with this share of its limit is at it: forces are smooth near it.
  static constexpr double kFull = 0.99;

  const Case& case_;
  const RigOptions& rig_;
  const Drape& drape_;
  const Mesh& mesh_;
  const Mold& mold_;
  FibreLines lines_;
  std::vector<bool> bridges_;
  std::vector<std::vector<int>> around_;  ///< nodes of the elements of each node
  std::vector<Eigen::Vector3d> feet_;
  std::vector<int> pads_;                  ///< the node in the middle of each
  std::vector<const Snapshot*> instants_;  ///< from the start to the end; empty: nobody looked
};

}  // namespace

FoldWords words_of(FoldKind kind) {
  switch (kind) {
    case FoldKind::edge:
      return {"edge", "unheld edge"};
    case FoldKind::bridging:
      return {"bridging", "bridging"};
    case FoldKind::held_up:
      return {"held_up", "held up by a pad"};
    case FoldKind::pad_rim:
      return {"pad_rim", "shear at a pad's rim"};
    case FoldKind::slack:
      return {"slack", "slack between grippers"};
    case FoldKind::stall:
      return {"stall", "friction stall"};
  }
  return {};
}

std::vector<Fold> folds_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity) {
  if (!last_score(drape).valid) return {};
  return FoldFinder(problem, drape, fidelity).find();
}

}  // namespace drapeplan
