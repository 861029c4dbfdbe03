// The pictures of a study, and which errors its tables and pictures show.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "planner/study/study.hpp"

namespace drapeplan {

/// An error as tables and charts show it: lengths in mm, shares in per cent.
struct StudyColumn {
  std::string name;  ///< as in StudyPoint::error
  std::string head;
  double factor = 1;
};

std::vector<StudyColumn> study_columns(const Study& study);

/// NaN for a point without it.
double error_of(const StudyPoint& point, const std::string& name);

/// Indices of the points on the Pareto front of processor time and an error, by time. Softer fibres are
/// another material, and not asked.
std::vector<int> study_front(const Study& study, const std::string& error);

/// SVG by name: work and precision, knobs, mapping, ranks, searches; of the parts that the study has.
std::map<std::string, std::string> study_charts(const Study& study);

}  // namespace drapeplan
