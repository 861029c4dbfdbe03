#include "planner/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

/// So many strokes are named, if their effects are at least this share of the largest.
constexpr size_t kNamed = 4;
constexpr double kNamedShare = 0.3;

std::string millimetres(double metres) {
  return fmt::format("{:.1f} mm", 1e3 * metres);
}

std::string place_text(const Eigen::Vector2d& at) {
  return fmt::format("({:.0f}, {:.0f}) mm of the flat ply", 1e3 * at.x(), 1e3 * at.y());
}

std::string grippers_text(const std::vector<int>& grippers, const RigOptions& rig) {
  std::vector<std::string> names;
  for (const int g : grippers) names.push_back(rig.name(g));
  return fmt::format("{} {}", names.size() == 1 ? "gripper" : "grippers", fmt::join(names, " and "));
}

const char* fibre_text(Fibre fibre) {
  return fibre == Fibre::warp ? "warp" : "weft";
}

/// What happens there: a clause.
std::string cause_text(const Fold& fold, const RigOptions& rig) {
  const std::string grippers = grippers_text(fold.grippers, rig);
  switch (fold.kind) {
    case FoldKind::edge:
      return fmt::format("a margin of the ply that nothing holds down, {:.0f} mm from {}",
                         1e3 * (rig.place(fold.grippers.front()) - fold.at).norm(), grippers);
    case FoldKind::bridging:
      return fmt::format(
          "between {} the {} spans a hollow of the mold as a chord: it is {} shorter than the mold "
          "below it",
          grippers, fibre_text(fold.fibre), millimetres(std::max(-fold.slack, 0.0)));
    case FoldKind::held_up:
      return fmt::format("the pad of {} stands {} above the mold itself", grippers,
                         millimetres(fold.pad_gap));
    case FoldKind::pad_rim:
      return fmt::format("the ply shears around the pad of {} but not under it", grippers);
    case FoldKind::slack:
    case FoldKind::stall:
      break;
  }
  const std::string more = fmt::format(
      "along the {} the ply is {} longer than the mold below it, which raises an arch of {} on {:.0f} mm",
      fibre_text(fold.fibre), millimetres(fold.slack), millimetres(arch_height(fold.slack, fold.span)),
      1e3 * fold.span);
  if (fold.kind == FoldKind::slack)
    return fmt::format("between {} {}: they landed too near to each other", grippers, more);
  return fmt::format(
      "{}; both sides of it lay on the mold since {:.1f} s, before {}: what is too long could not slide out",
      more, fold.sides_down,
      std::isnan(fold.down) ? grippers + " did, which never came down"
                            : fmt::format("the last of {} did", grippers));
}

std::string held_text(const Fold& fold, const RigOptions& rig) {
  if (fold.grippers.empty()) return {};
  std::string text;
  const bool several = fold.grippers.size() > 1;
  if (fold.kind != FoldKind::held_up && 2 * fold.pad_gap > fold.height)
    text += fmt::format("; a pad there stands {} above the mold", millimetres(fold.pad_gap));
  if (fold.saturated)
    text += fmt::format("; {} at the limit of force, {:g} N, at the end",
                        several ? "an actuator there is" : "its actuator is", rig.actuator_force_limit);
  return text;
}

std::string time_text(const Fold& fold) {
  if (std::isnan(fold.before)) return {};  // nobody looked
  if (std::isnan(fold.since)) return "; it has not come to rest by the end";
  const std::string when = fold.before < fold.since
                               ? fmt::format("; it stands since {:.1f} to {:.1f} s", fold.before, fold.since)
                               : fmt::format("; it stands since {:.1f} s", fold.since);
  if (!(fold.down > 0) || fold.kind == FoldKind::edge || fold.kind == FoldKind::held_up) return when;
  return fmt::format("{}, the last of these pads is down since {:.1f} s", when, fold.down);
}

std::string edge_text(const EdgeMiss& edge, const RigOptions& rig) {
  std::string text =
      fmt::format("The edge is farthest off, by {}, at {}: it {} the boundary.", millimetres(edge.offset),
                  place_text(edge.at), edge.short_of ? "stays short of" : "reaches beyond");
  const std::string name = rig.name(edge.gripper);
  if (edge.by_gripper())
    return text +
           fmt::format(" The grippers put it there: {}, the nearest, is {} off its target to the same side.",
                       name, millimetres(edge.pad_offset));
  if (edge.pad_offset < -0.5 * edge.offset)
    return text +
           fmt::format(
               " The nearest gripper, {}, is {} off to the other side: the ply between them is stretched or "
               "sheared by more than both.",
               name, millimetres(-edge.pad_offset));
  return text +
         fmt::format(
             " The nearest gripper, {}, is only {} off that way: it is the {:.0f} mm of ply beyond it that "
             "slid, sheared or folded.",
             name, millimetres(std::abs(edge.pad_offset)), 1e3 * edge.margin);
}

std::string effects_text(const std::vector<StrokeEffect>& effects, const RigOptions& rig) {
  std::vector<std::string> named;
  for (size_t k = 0; k < std::min(effects.size(), kNamed); ++k) {
    const StrokeEffect& effect = effects[k];
    if (!(effect.size() > kNamedShare * effects.front().size())) break;
    named.push_back(fmt::format("the {} of {} ({:.2f})", effect.height ? "height" : "start",
                                rig.name(effect.gripper), effect.size()));
  }
  if (named.empty()) return {};
  return fmt::format(
      "What matters most of the schedule is {}; in brackets, by how much the objective is expected to "
      "change where this alone is {:g} mm or {:g} s off.",
      fmt::join(named, ", "), 1e3 * kHeightStep, kStartStep);
}

nlohmann::json names_json(const std::vector<int>& grippers, const RigOptions& rig) {
  nlohmann::json list = nlohmann::json::array();
  for (const int g : grippers) list.push_back(rig.indices(g));
  return list;
}

nlohmann::json fold_json(const Fold& fold, const RigOptions& rig) {
  return {{"kind", key_of(fold.kind)},
          {"at", {fold.at.x(), fold.at.y()}},
          {"height", fold.height},
          {"fibre", fibre_text(fold.fibre)},
          {"span", fold.span},
          {"slack", fold.slack},
          {"grippers", names_json(fold.grippers, rig)},
          {"pad_gap", fold.pad_gap},
          {"saturated", fold.saturated},
          {"since", finite(fold.since)},
          {"before", finite(fold.before)},
          {"down", finite(fold.down)},
          {"sides_down", finite(fold.sides_down)}};
}

}  // namespace

const Fold* Diagnosis::first() const {
  const Fold* first = nullptr;
  for (const Fold& fold : folds) {
    if (!std::isnan(fold.since) && (first == nullptr || fold.since < first->since)) first = &fold;
  }
  return first;
}

Diagnosis diagnosis_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                       std::vector<StrokeEffect> effects) {
  Diagnosis diagnosis;
  if (!drape.score.valid) return diagnosis;
  diagnosis.folds = folds_of(problem, drape, fidelity);
  const EdgeMiss edge = edge_miss_of(problem, drape, fidelity);
  if (edge.offset > problem.definition().score.target_boundary_offset) diagnosis.edge = edge;
  diagnosis.effects = std::move(effects);
  return diagnosis;
}

std::string diagnosis_text(const Diagnosis& diagnosis, const RigOptions& rig) {
  std::vector<std::string> sentences;
  if (!diagnosis.folds.empty()) {
    const Fold& highest = diagnosis.folds.front();
    sentences.push_back(fmt::format(
        "The ply is highest, {}, at {} ({}): {}{}{}.", millimetres(highest.height), place_text(highest.at),
        name_of(highest.kind), cause_text(highest, rig), held_text(highest, rig), time_text(highest)));
    const Fold* first = diagnosis.first();
    if (first != nullptr && first != &highest)
      sentences.push_back(fmt::format("The first that stands, {} high, is at {} ({}): {}{}.",
                                      millimetres(first->height), place_text(first->at), name_of(first->kind),
                                      cause_text(*first, rig), time_text(*first)));
  }
  if (diagnosis.edge) sentences.push_back(edge_text(*diagnosis.edge, rig));
  if (std::string effects = effects_text(diagnosis.effects, rig); !effects.empty() && !diagnosis.good())
    sentences.push_back(std::move(effects));
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string remedy_text(const Diagnosis& diagnosis, const RigOptions& rig) {
  std::vector<std::string> sentences;
  std::set<FoldKind> told;
  const bool closes = rig.interlinks && !rig.interlinks->lengths.empty();
  for (const Fold& fold : diagnosis.folds) {
    if (!told.insert(fold.kind).second) continue;
    switch (fold.kind) {
      case FoldKind::edge:
        sentences.emplace_back("Put grippers nearer to the ply's edge, or press it down.");
        break;
      case FoldKind::bridging:
        sentences.emplace_back(
            rig.interlinks && !closes
                ? "A chord needs grippers that come nearer to each other: let the interlinks close "
                  "(grippers.interlinks), or press the ply."
                : "A chord needs grippers that land nearer to each other, or a press.");
        break;
      case FoldKind::held_up:
        sentences.emplace_back(
            fold.saturated && rig.interlinks
                ? "A pad that its actuator cannot press down is held up by its interlinks: let them close, "
                  "give way (grippers.interlinks) or use more force (grippers.actuator_force_limit)."
                : "A pad that stands above the mold needs to be commanded lower (schedule.overtravel) or a "
                  "stiffer actuator.");
        break;
      case FoldKind::pad_rim:
        sentences.emplace_back("Smaller pads (grippers.pad_radius) shear with the ply.");
        break;
      case FoldKind::slack:
        sentences.emplace_back(
            rig.interlinks
                ? "Slack between grippers goes where they land further apart: their heights before they "
                  "land decide it, as long as the interlinks let them."
                : "Slack between grippers goes where they land further apart.");
        break;
      case FoldKind::stall:
        sentences.emplace_back(
            "A stall goes where the ply touches the mold later than the grippers around it, or with less "
            "friction: begin at this place.");
        break;
    }
  }
  if (diagnosis.edge && diagnosis.edge->by_gripper())
    sentences.emplace_back(rig.driven == Driven::z
                               ? "The edge follows its grippers, which only heights move in-plane: "
                                 "drapeplan reach shows how near they can come."
                               : "The edge follows its grippers.");
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string reasons_text(const Diagnosis& diagnosis, const RigOptions& rig) {
  std::string text;
  for (const std::string& part : {diagnosis_text(diagnosis, rig), remedy_text(diagnosis, rig)}) {
    if (!part.empty()) text += part + "\n";
  }
  return text;
}

nlohmann::json diagnosis_json(const Diagnosis& diagnosis, const RigOptions& rig) {
  nlohmann::json folds = nlohmann::json::array(), effects = nlohmann::json::array();
  for (const Fold& fold : diagnosis.folds) folds.push_back(fold_json(fold, rig));
  for (const StrokeEffect& effect : diagnosis.effects)
    effects.push_back({{"gripper", rig.indices(effect.gripper)},
                       {"of", effect.height ? "height" : "start"},
                       {"value", effect.value},
                       {"more", effect.more},
                       {"less", effect.less}});
  nlohmann::json result{{"text", diagnosis_text(diagnosis, rig)},
                        {"remedy", remedy_text(diagnosis, rig)},
                        {"folds", std::move(folds)},
                        {"effects", std::move(effects)}};
  if (const auto& edge = diagnosis.edge)
    result["edge"] = {{"at", {edge->at.x(), edge->at.y()}},
                      {"offset", edge->offset},
                      {"short", edge->short_of},
                      {"gripper", rig.indices(edge->gripper)},
                      {"pad_offset", edge->pad_offset}};
  return result;
}

}  // namespace drapeplan
