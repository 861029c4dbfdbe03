#include <algorithm>

#include "planner/stress/kit.hpp"

namespace drapeplan {

std::vector<StressScene> stress_scenes() {
  std::vector<StressScene> scenes;
  add_shear_scenes(scenes);
  add_sheet_scenes(scenes);
  add_mold_scenes(scenes);
  add_rig_scenes(scenes);
  add_press_scenes(scenes);
  add_tack_scenes(scenes);
  add_numeric_scenes(scenes);
  // Scenes of a group stand together, in the order in which groups first appear.
  std::vector<std::string> groups;
  for (const StressScene& scene : scenes) {
    if (std::find(groups.begin(), groups.end(), scene.group) == groups.end()) groups.push_back(scene.group);
  }
  const auto rank = [&groups](const StressScene& scene) {
    return std::find(groups.begin(), groups.end(), scene.group) - groups.begin();
  };
  std::stable_sort(scenes.begin(), scenes.end(),
                   [&rank](const StressScene& a, const StressScene& b) { return rank(a) < rank(b); });
  return scenes;
}

}  // namespace drapeplan
