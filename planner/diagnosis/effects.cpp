#include "planner/diagnosis/effects.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drapeplan {

double StrokeEffect::size() const {
  return std::max(std::abs(more), std::abs(less));
}

std::vector<StrokeEffect> stroke_effects(const Learned& learned) {
  const double here = learned.objective(learned.strokes);
  const auto change = [&](int gripper, double Stroke::*value, double step) {
    Strokes strokes = learned.strokes;
    strokes[size_t(gripper)].*value += step;
    shift_to_gauge(strokes);
    return learned.objective(strokes) - here;
  };
  std::vector<StrokeEffect> effects;
  for (int g = 0; g < int(learned.strokes.size()); ++g) {
    for (const auto& [value, step] : {std::pair{&Stroke::height, kHeightStep}, {&Stroke::start, kStartStep}})
      effects.push_back({.gripper = g,
                         .height = value == &Stroke::height,
                         .value = learned.strokes[size_t(g)].*value,
                         .more = change(g, value, step),
                         .less = change(g, value, -step)});
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const StrokeEffect& a, const StrokeEffect& b) { return a.size() > b.size(); });
  return effects;
}

}  // namespace drapeplan
