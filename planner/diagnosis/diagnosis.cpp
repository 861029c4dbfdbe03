#include "planner/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "planner/drape/acceptance.hpp"
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

/// "between grippers [1, 1] and [2, 1]", "beside gripper [1, 1]".
std::string between_text(const std::vector<int>& grippers, const RigOptions& rig) {
  return (grippers.size() > 1 ? "between " : "beside ") + grippers_text(grippers, rig);
}

std::string slack_text(const Fold& fold, const RigOptions& rig) {
  const std::string where = between_text(fold.grippers, rig);
  const std::string more = fmt::format(
      "along the {} the ply is {} longer than the mold below it, which raises an arch of {} "
      "on {:.0f} mm",
      fibre_text(fold.fibre), millimetres(fold.slack), millimetres(fold.arch), 1e3 * fold.span);
  const bool several = fold.grippers.size() > 1;
  if (fold.kind == FoldKind::slack)
    return fmt::format("{} {}{}", where, more, several ? ": they landed too near to each other" : "");
  const std::string late = std::isnan(fold.down)
                               ? fmt::format("{} is up to the end", several ? "one of these grippers" : "it")
                           : several ? "the last of these grippers was down"
                                     : "it was down";
  return fmt::format(
      "{} {}; both sides of it lay on the mold by {:.1f} s, before {}: what is too long could not slide out",
      where, more, fold.sides_down, late);
}

/// What happens there: a clause.
std::string cause_text(const Fold& fold, const RigOptions& rig) {
  const std::string grippers = grippers_text(fold.grippers, rig);
  switch (fold.kind) {
    case FoldKind::bridging: {
      const std::string where = between_text(fold.grippers, rig);
      if (fold.slack >= 0)
        return fmt::format("{} the ply spans a hollow of the mold with a taut {}", where,
                           fibre_text(fold.fibre));
      return fmt::format(
          "{} the {} spans a hollow of the mold as a chord: it is {} shorter than the mold below it", where,
          fibre_text(fold.fibre), millimetres(-fold.slack));
    }
    case FoldKind::edge:
      return fmt::format("a margin of the ply that nothing holds down, {:.0f} mm from {}",
                         1e3 * (rig.place(fold.grippers.front()) - fold.at).norm(), grippers);
    case FoldKind::held_up:
      return fmt::format("the pad of {} stands {} above the mold itself", grippers,
                         millimetres(fold.pad_gap));
    case FoldKind::pad_rim:
      return fmt::format("the ply shears around the pad of {} but not under it", grippers);
    case FoldKind::stall:
    case FoldKind::slack:
      return slack_text(fold, rig);
  }
  return {};
}

std::string held_text(const Fold& fold, const RigOptions& rig) {
  std::string text;
  const bool several = fold.grippers.size() > 1;
  if (fold.kind != FoldKind::held_up && fold.pad_gap > kHeldShare * fold.height)
    text += fmt::format("; a pad there stands {} above the mold", millimetres(fold.pad_gap));
  if (fold.saturated)
    text += fmt::format("; at the end {} at the limit of force, {:g} N",
                        several ? "an actuator there is" : "its actuator is", rig.actuator_force_limit);
  return text;
}

/// Nothing where nobody looked.
std::string time_text(const Fold& fold) {
  if (std::isnan(fold.before)) return {};
  if (std::isnan(fold.since)) return "; it has not come to rest by the end";
  const std::string when =
      fold.before < fold.since
          ? fmt::format("; the fold stands since {:.1f} to {:.1f} s", fold.before, fold.since)
          : "; the fold stands since the start";
  if (!(fold.down > 0) || fold.kind == FoldKind::edge || fold.kind == FoldKind::held_up) return when;
  return fmt::format("{}, {} down by {:.1f} s", when,
                     fold.grippers.size() > 1 ? "the last of these pads is" : "its pad is", fold.down);
}

std::string edge_text(const EdgeMiss& edge, const RigOptions& rig) {
  const char* side = edge.side == EdgeSide::short_of ? "stays short of"
                     : edge.side == EdgeSide::beyond ? "reaches beyond"
                                                     : "stands above";
  const std::string text = fmt::format("The edge is farthest off, by {}, at {}: it {} the boundary.",
                                       millimetres(edge.offset), place_text(edge.at), side);
  const std::string name = rig.name(edge.gripper);
  if (edge.by_gripper())
    return text +
           fmt::format(" The grippers put it there: {}, the nearest, is {} off its target to the same side.",
                       name, millimetres(edge.pad_offset));
  if (edge.against_gripper())
    return text + fmt::format(
                      " The nearest gripper, {}, is {} off its target to the other side: the {:.0f} mm of "
                      "ply between "
                      "them are off by more than that.",
                      name, millimetres(-edge.pad_offset), 1e3 * edge.margin);
  return text + fmt::format(
                    " Its nearest gripper, {}, is not far from its target that way ({}): the {:.0f} mm of "
                    "ply beyond it "
                    "slid, sheared or folded.",
                    name, millimetres(edge.pad_offset), 1e3 * edge.margin);
}

std::string effects_text(const StrokeEffects& effects, const RigOptions& rig) {
  std::vector<std::string> named;
  const double largest = effects.values.front().size();
  for (size_t k = 0; k < std::min(effects.values.size(), kNamed); ++k) {
    const StrokeEffect& effect = effects.values[k];
    if (!(effect.size() > 0 && effect.size() >= kNamedShare * largest)) break;
    const double change = std::abs(effect.more) == effect.size() ? effect.more : effect.less;
    named.push_back(fmt::format("the {} of {} ({:+.2f})", effect.height ? "height" : "start",
                                rig.name(effect.gripper), change));
  }
  if (named.empty()) return {};
  return fmt::format(
      "What matters most of the schedule is {}; in brackets, the change of the objective at `{}` where this "
      "alone is {:g} mm or {:g} s off.",
      fmt::join(named, ", "), effects.fidelity, 1e3 * kHeightStep, kStartStep);
}

nlohmann::json names_json(const std::vector<int>& grippers, const RigOptions& rig) {
  nlohmann::json list = nlohmann::json::array();
  for (const int g : grippers) list.push_back(rig.indices(g));
  return list;
}

nlohmann::json fold_json(const Fold& fold, const RigOptions& rig) {
  return {{"kind", words_of(fold.kind).key},
          {"at", {fold.at.x(), fold.at.y()}},
          {"height", fold.height},
          {"fibre", fibre_text(fold.fibre)},
          {"span", fold.span},
          {"slack", fold.slack},
          {"arch", fold.arch},
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
                       std::optional<StrokeEffects> effects) {
  Diagnosis diagnosis;
  if (!last_score(drape).valid) return diagnosis;
  diagnosis.pressed = drape.other.has_value();
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
        "{} is highest, {}, at {} ({}): {}{}{}.", diagnosis.pressed ? "After pressing the ply" : "The ply",
        millimetres(highest.height), place_text(highest.at), words_of(highest.kind).name,
        cause_text(highest, rig), held_text(highest, rig), time_text(highest)));
    const Fold* first = diagnosis.first();
    if (first != nullptr && first != &highest)
      sentences.push_back(fmt::format(
          "The first that stands, {} high, is at {} ({}): {}{}.", millimetres(first->height),
          place_text(first->at), words_of(first->kind).name, cause_text(*first, rig), time_text(*first)));
  }
  if (diagnosis.edge) sentences.push_back(edge_text(*diagnosis.edge, rig));
  if (diagnosis.effects && !diagnosis.good()) sentences.push_back(effects_text(*diagnosis.effects, rig));
  std::erase(sentences, std::string());
  return fmt::format("{}", fmt::join(sentences, " "));
}

namespace {

/// What would change a fold of this kind.
std::string remedy_of(const Fold& fold, const RigOptions& rig, bool pressed) {
  const bool closes = rig.interlinks && !rig.interlinks->lengths.empty();
  const char* press = pressed ? "." : ", or press the ply.";
  switch (fold.kind) {
    case FoldKind::bridging:
      return std::string("A chord needs grippers that come nearer to each other") +
             (rig.interlinks && !closes ? ": let the interlinks close (grippers.interlinks)" : "") + press;
    case FoldKind::edge:
      return std::string("Put grippers nearer to the ply's edge") + press;
    case FoldKind::held_up:
      if (!fold.saturated)
        return "A pad that stands above the mold needs to be commanded lower (schedule.overtravel), or a "
               "stiffer actuator.";
      return std::string(
                 "A pad that its actuator cannot press down needs more force "
                 "(grippers.actuator_force_limit)") +
             (rig.interlinks ? ", or interlinks that close or give way (grippers.interlinks)." : ".");
    case FoldKind::pad_rim:
      return "Smaller pads (grippers.pad_radius) shear with the ply.";
    case FoldKind::stall:
      return "Where friction stalled the ply, let the grippers land from this place outwards, or lower the "
             "friction.";
    case FoldKind::slack:
      return std::string("Slack between grippers goes where they land further apart") +
             (rig.interlinks
                  ? ": their heights before they land decide it, as long as the interlinks let them."
                  : ".");
  }
  return {};
}

std::string remedy_of(const EdgeMiss& edge, const RigOptions& rig) {
  if (!edge.by_gripper())
    return "Grippers nearer to the edge, or more of them, hold the margin of the ply in its place.";
  if (rig.driven == Driven::z)
    return "The edge follows its grippers. Only z is driven: the heights of neighbours before they land move "
           "them in-plane.";
  return "The edge follows its grippers, which are late or too weak for the ply: slower strokes, or more "
         "force.";
}

}  // namespace

std::string remedy_text(const Diagnosis& diagnosis, const RigOptions& rig) {
  std::vector<std::string> sentences;
  std::set<FoldKind> told;
  for (const Fold& fold : diagnosis.folds) {
    if (told.insert(fold.kind).second) sentences.push_back(remedy_of(fold, rig, diagnosis.pressed));
  }
  if (diagnosis.edge) sentences.push_back(remedy_of(*diagnosis.edge, rig));
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
  if (diagnosis.effects) {
    for (const StrokeEffect& effect : diagnosis.effects->values)
      effects.push_back({{"gripper", rig.indices(effect.gripper)},
                         {"of", effect.height ? "height" : "start"},
                         {"value", effect.value},
                         {"more", finite(effect.more)},
                         {"less", finite(effect.less)}});
  }
  nlohmann::json result{{"text", diagnosis_text(diagnosis, rig)},
                        {"remedy", remedy_text(diagnosis, rig)},
                        {"folds", std::move(folds)},
                        {"effects", std::move(effects)}};
  if (diagnosis.effects) result["effects_fidelity"] = diagnosis.effects->fidelity;
  if (const auto& edge = diagnosis.edge)
    result["edge"] = {{"at", {edge->at.x(), edge->at.y()}},
                      {"offset", edge->offset},
                      {"side", edge->side == EdgeSide::short_of ? "short"
                               : edge->side == EdgeSide::beyond ? "beyond"
                                                                : "above"},
                      {"gripper", rig.indices(edge->gripper)},
                      {"pad_offset", edge->pad_offset}};
  return result;
}

std::optional<StrokeEffects> effects_from(const nlohmann::json& value, const RigOptions& rig) {
  if (!value.contains("effects_fidelity")) return std::nullopt;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  StrokeEffects effects{.fidelity = value.at("effects_fidelity").get<std::string>(), .values = {}};
  for (const nlohmann::json& one : value.at("effects")) {
    const int gripper = rig.gripper_at(one.at("gripper").get<std::array<int, 2>>());
    if (gripper < 0 || gripper >= rig.count()) throw std::invalid_argument("effects: no gripper of this rig");
    effects.values.push_back({.gripper = gripper,
                              .height = one.at("of") == "height",
                              .value = one.at("value").get<double>(),
                              .more = number_or(one.at("more"), kNaN),
                              .less = number_or(one.at("less"), kNaN)});
  }
  if (effects.values.empty()) throw std::invalid_argument("effects: there are none");
  return effects;
}

}  // namespace drapeplan
