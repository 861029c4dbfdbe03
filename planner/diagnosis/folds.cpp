#include "planner/diagnosis/folds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Of two folds that are nearer to each other than this share of the spacing only the higher one counts.
constexpr double kApart = 0.5;
/// A fold reaches along its fibre to where the ply is lower than this share of its height, or rises again by
/// the other one from node to node.
constexpr double kFoot = 0.1, kRise = 0.02;
/// A pad that stands above the mold by this share of a fold beside it holds it up.
constexpr double kHeldShare = 0.5;
/// What lies nearer to a pad's centre than this many radii lies at its rim.
constexpr double kRim = 1.5;
/// Shear of the ply beside a pad, whose own piece cannot shear, from which a fold at the rim is laid to it:
/// over the radius of a pad it displaces the ply by a tenth of that radius.
constexpr double kRimShearDeg = 6;
/// Share of a fold's height that the slack of a fibre must explain, where the other fibre is a chord.
constexpr double kExplained = 0.5;
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
        bridges_(bridging(mesh_, drape.run.final, mold_)) {
    for (const Eigen::Vector3d& place : drape.run.final.position) feet_.push_back(mold_.closest(place).foot);
    for (int g = 0; g < rig_.count(); ++g) pads_.push_back(nearest_node(rig_.place(g)));
  }

  std::vector<Fold> find() const {
    std::vector<Fold> folds;
    std::vector<int> order(mesh_.rest.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return gap(a) > gap(b); });
    for (const int node : order) {
      if (!(gap(node) > case_.score.target_gap) || int(folds.size()) == kMostFolds) break;
      const bool apart = std::all_of(folds.begin(), folds.end(), [&](const Fold& fold) {
        return (fold.at - mesh_.rest[size_t(node)]).norm() >= kApart * rig_.spacing;
      });
      if (apart && is_peak(node)) folds.push_back(fold_at(node));
    }
    return folds;
  }

 private:
  [[nodiscard]] double gap(int node) const { return drape_.gap[size_t(node)]; }

  /// No neighbour along a fibre is higher: a slope of a higher fold is no fold of its own.
  [[nodiscard]] bool is_peak(int node) const {
    for (const Fibre fibre : {Fibre::warp, Fibre::weft}) {
      for (const bool forward : {false, true}) {
        const std::optional<int> next = lines_.next(node, fibre, forward);
        if (next && gap(*next) > gap(node)) return false;
      }
    }
    return true;
  }

  [[nodiscard]] int nearest_node(const Eigen::Vector2d& at) const {
    const auto nearest = std::min_element(
        mesh_.rest.begin(), mesh_.rest.end(),
        [&](const auto& a, const auto& b) { return (a - at).squaredNorm() < (b - at).squaredNorm(); });
    return int(nearest - mesh_.rest.begin());
  }

  [[nodiscard]] int nearest_gripper(const Eigen::Vector2d& at) const {
    int nearest = 0;
    for (int g = 1; g < rig_.count(); ++g) {
      if ((rig_.place(g) - at).norm() < (rig_.place(nearest) - at).norm()) nearest = g;
    }
    return nearest;
  }

  /// The grippers beside a place of a fibre, one on each side where there are two.
  [[nodiscard]] std::vector<int> beside(const Eigen::Vector2d& at, Fibre fibre) const {
    const int along = fibre == Fibre::warp ? 0 : 1;
    std::vector<int> found;
    for (const double side : {-1.0, 1.0}) {
      int nearest = -1;
      for (int g = 0; g < rig_.count(); ++g) {
        if (side * (rig_.place(g)[along] - at[along]) < 0) continue;
        if (nearest < 0 || (rig_.place(g) - at).norm() < (rig_.place(nearest) - at).norm()) nearest = g;
      }
      if (nearest >= 0 && (found.empty() || found.front() != nearest)) found.push_back(nearest);
    }
    return found;
  }

  /// From valley to valley, or from where the ply is low.
  [[nodiscard]] FibreSpan span_of(int node, Fibre fibre) const {
    const double low = kFoot * gap(node), rise = kRise * gap(node);
    return lines_.span(
        node, fibre, [&](int from, int to) { return gap(from) > low && gap(to) < gap(from) + rise; },
        drape_.run.final.position, feet_);
  }

  [[nodiscard]] double gap_in(const Snapshot& frame, int node) const {
    const Eigen::Vector3d& place = frame.position[size_t(node)];
    return std::max(mold_.closest(place).signed_distance - 0.5 * case_.material.thickness, 0.0);
  }

  /// The first instant from which on `holds` is true of all frames, and the one before it.
  template <class Holds>
  [[nodiscard]] std::array<double, 2> since(const Holds& holds) const {
    std::array<double, 2> found{kNaN, kNaN};
    for (auto frame = drape_.frames.rbegin(); frame != drape_.frames.rend(); ++frame) {
      if (!holds(*frame)) {
        found[1] = frame->time;
        break;
      }
      found[0] = found[1] = frame->time;
    }
    return found;
  }

  /// When a node came down to `height` for good [s].
  [[nodiscard]] double down(int node, double height) const {
    return since([&](const Snapshot& frame) { return gap_in(frame, node) <= height; })[0];
  }

  /// An end of a span is at the ply's edge and as good as not lower.
  [[nodiscard]] bool reaches_edge(int node, const FibreSpan& warp, const FibreSpan& weft) const {
    const double high = kHeldShare * gap(node);
    for (const FibreSpan* span : {&warp, &weft}) {
      if (span->from_edge && gap(span->nodes.front()) > high) return true;
      if (span->to_edge && gap(span->nodes.back()) > high) return true;
    }
    return false;
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

  [[nodiscard]] Fold fold_at(int node) const {
    Fold fold;
    fold.node = node;
    fold.at = mesh_.rest[size_t(node)];
    fold.height = gap(node);
    const FibreSpan warp = span_of(node, Fibre::warp), weft = span_of(node, Fibre::weft);
    const Fibre more = warp.slack() >= weft.slack() ? Fibre::warp : Fibre::weft;
    const FibreSpan& longer = more == Fibre::warp ? warp : weft;
    const double least = std::min(warp.slack(), weft.slack());
    const bool arch = arch_height(longer.slack(), longer.below) >= kExplained * fold.height;
    const bool chord = bridges_[size_t(node)] || longer.slack() <= 0 || (!arch && least < 0);
    fold.fibre = chord == (more == Fibre::warp) ? Fibre::weft : Fibre::warp;
    const FibreSpan& span = fold.fibre == Fibre::warp ? warp : weft;
    fold.span = span.below;
    fold.slack = span.slack();
    fold.grippers = beside(fold.at, fold.fibre);
    const int nearest = nearest_gripper(fold.at);
    const double distance = (rig_.place(nearest) - fold.at).norm();
    const double nearest_gap = gap(pads_[size_t(nearest)]);
    if (chord) {
      fold.kind = FoldKind::bridging;
    } else if (reaches_edge(node, warp, weft) && distance > rig_.pad_radius &&
               nearest_gap < kHeldShare * fold.height) {
      fold.kind = FoldKind::edge;
      fold.grippers = {nearest};
    } else if (nearest_gap >= kHeldShare * fold.height) {
      fold.kind = FoldKind::held_up;
      fold.grippers = {nearest};
    } else if (distance < kRim * rig_.pad_radius && rim_shear(nearest) > kRimShearDeg) {
      fold.kind = FoldKind::pad_rim;
      fold.grippers = {nearest};
    }
    hold(fold);
    // Both sides of the arch lay on the mold before the pads did: they were not what pushed it up.
    fold.sides_down =
        later(down(span.nodes.front(), kFoot * fold.height), down(span.nodes.back(), kFoot * fold.height));
    if (fold.kind == FoldKind::slack &&
        (fold.sides_down < fold.down || (std::isnan(fold.down) && !std::isnan(fold.sides_down))))
      fold.kind = FoldKind::stall;
    return fold;
  }

  /// What is known of the grippers of a fold, and its times.
  void hold(Fold& fold) const {
    const std::vector<double>& force = drape_.run.final.actuator_force;
    fold.down = fold.grippers.empty() ? kNaN : 0;
    for (const int g : fold.grippers) {
      fold.pad_gap = std::max(fold.pad_gap, gap(pads_[size_t(g)]));
      if (size_t(g) < force.size() && std::abs(force[size_t(g)]) >= kFull * rig_.actuator_force_limit)
        fold.saturated = true;
      fold.down = later(fold.down, down(pads_[size_t(g)], case_.score.target_gap));
    }
    const double near = std::max(kSettled * fold.height, case_.score.target_gap);
    const auto [stands, before] = since(
        [&](const Snapshot& frame) { return std::abs(gap_in(frame, fold.node) - fold.height) <= near; });
    fold.since = stands;
    fold.before = before;
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
  std::vector<Eigen::Vector3d> feet_;
  std::vector<int> pads_;  ///< the node in the middle of each
};

}  // namespace

std::string name_of(FoldKind kind) {
  switch (kind) {
    case FoldKind::edge:
      return "unheld edge";
    case FoldKind::bridging:
      return "bridging";
    case FoldKind::held_up:
      return "held up by a pad";
    case FoldKind::pad_rim:
      return "shear at a pad's rim";
    case FoldKind::slack:
      return "slack between grippers";
    case FoldKind::stall:
      return "friction stall";
  }
  return {};
}

const char* key_of(FoldKind kind) {
  switch (kind) {
    case FoldKind::edge:
      return "edge";
    case FoldKind::bridging:
      return "bridging";
    case FoldKind::held_up:
      return "held_up";
    case FoldKind::pad_rim:
      return "pad_rim";
    case FoldKind::slack:
      return "slack";
    case FoldKind::stall:
      return "stall";
  }
  return "";
}

std::vector<Fold> folds_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity) {
  if (!drape.score.valid) return {};
  return FoldFinder(problem, drape, fidelity).find();
}

}  // namespace drapeplan
