#include "fem/rig.hpp"

namespace drapeplan {

std::vector<double> column_places(const RigOptions& rig) {
  std::vector<double> places;
  for (int i = 0; i < rig.columns; ++i) places.push_back(rig.place(i).x());
  return places;
}

std::vector<double> row_places(const RigOptions& rig) {
  std::vector<double> places;
  for (int j = 0; j < rig.rows; ++j) places.push_back(rig.place(j * rig.columns).y());
  return places;
}

std::vector<std::array<int, 2>> interlinks(const RigOptions& rig) {
  std::vector<std::array<int, 2>> pairs;
  if (!rig.interlinks) return pairs;
  for (int j = 0; j < rig.rows; ++j) {
    for (int i = 0; i + 1 < rig.columns; ++i) pairs.push_back({j * rig.columns + i, j * rig.columns + i + 1});
  }
  for (int j = 0; j + 1 < rig.rows; ++j) {
    for (int i = 0; i < rig.columns; ++i) pairs.push_back({j * rig.columns + i, (j + 1) * rig.columns + i});
  }
  return pairs;
}

}  // namespace drapeplan
