// Which settings a study tries.

#include <algorithm>
#include <stdexcept>

#include "mapping/error.hpp"
#include "planner/drape/problem.hpp"
#include "planner/study/study.hpp"

namespace drapeplan {
namespace {

/// A knob and its values, the most careful one first.
struct Knob {
  std::string curve, path;
  std::vector<std::string> values;
};

/// Whether something is driven, so that it may be driven faster.
bool is_driven(const Case& base) {
  return base.grippers || !base.grips.empty();
}

std::vector<Knob> knobs(const Case& base) {
  const FemOptions& fem = base.fidelities.at(kReport);
  Knob mesh{"mesh size", "fem.mesh_size", {}};
  for (const double factor : {0.5, 0.6, 0.75, 1.0, 1.25, 1.5, 2.0})
    mesh.values.push_back(rounded_length(factor * fem.mesh_size));
  std::vector<Knob> list{
      mesh,
      {"mass scaling", "fem.mass_scaling", {"1", "4", "20", "60", "160", "400"}},
      {"step safety", "fem.step_safety", {"0.2", "0.3", "0.45", "0.6", "0.75", "0.9", "0.95"}},
      {"section points", "fem.section_points", {"5", "3", "1"}},
      {"precision", "fem.precision", {"double", "single"}},
      {"fibre points", "fem.fibre_points", {"2", "1"}},
      {"fibre inertia", "fem.fibre_mass_scaling", {"1", "2", "3", "4", "6", "8"}}};
  if (is_driven(base)) list.push_back({"time scaling", "fem.time_scaling", {"1", "2", "4", "8", "16", "32"}});
  list.push_back({"fibre stiffness", "material.tension.factor", {"1", "0.5", "0.2", "0.05", "0.01"}});
  if (base.material.shear.curves.size() > 1 || base.material.compression.curves.size() > 1)
    list.push_back({"rates", "fem.rates", {"true", "false"}});
  return list;
}

/// Whether the case has this field at all: a linear law has no tables to soften.
bool can_turn(const StudySubject& subject, const Knob& knob) {
  try {
    (void)subject.with({{knob.path, knob.values.front()}});
    return true;
  } catch (const WrongInput&) {
    return false;
  }
}

}  // namespace

std::vector<StudyPoint> sweep_points(const StudySubject& subject) {
  std::vector<StudyPoint> points;
  for (const Knob& knob : knobs(subject.base())) {
    if (!can_turn(subject, knob)) continue;
    for (const std::string& value : knob.values)
      points.push_back({knob.curve, {{knob.path, value}}, {}, {}, {}});
  }
  for (const std::string& name : subject.fidelities())
    points.push_back({"fidelity " + name, subject.changes_of(name), {}, {}, {}});
  const double mesh = subject.base().fidelities.at(kReport).mesh_size;
  struct Cheap {
    const char *mass, *time, *fibre_mass;
    bool single = false;
  };
  for (const double factor : {1.0, 1.5, 2.0}) {
    for (const Cheap cheap : {Cheap{"20", "8", "4"},
                              {"20", "8", "6"},
                              {"20", "16", "4"},
                              {"20", "16", "6"},
                              {"60", "8", "3"},
                              {"60", "16", "3"},
                              {"20", "8", "4", true}}) {
      Settings settings{{"fem.mesh_size", rounded_length(factor * mesh)},
                        {"fem.mass_scaling", cheap.mass},
                        {"fem.fibre_mass_scaling", cheap.fibre_mass}};
      if (is_driven(subject.base())) settings["fem.time_scaling"] = cheap.time;
      if (cheap.single) settings["fem.precision"] = "single";
      const auto same = [&settings](const StudyPoint& point) { return point.settings == settings; };
      if (std::none_of(points.begin(), points.end(), same))
        points.push_back({"combination", settings, {}, {}, {}});
    }
  }
  return points;
}

}  // namespace drapeplan
