// What a score is made of, as many numbers that change smoothly with the schedule. A search can learn these
// one by one; the score itself, of largest values and thresholds, is full of kinks.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"
#include "planner/case/score_options.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {

/// The fields of a drape at the nodes of one reference mesh, whatever mesh was simulated. With N nodes, M of
/// them on its outline:
///   N    gap with its sign, negative inside the mold [m]
///   N    bridging_strain of scoring.hpp [-]
///   3 M  the ply's edge, on its underside, world frame [m]
///   4    largest lag [m], largest shear [deg], largest fibre tension [-], duration [s]
class ScoreFields {
 public:
  /// For one mesh: four of its nodes and their weights per reference node.
  using Sampling = std::vector<std::pair<std::array<int, 4>, Eigen::Vector4d>>;

  /// @param mold  outlives this.  @param prescribed_boundary  closed, on the mold [m].
  /// @param thickness  of the ply [m].
  ScoreFields(Mesh reference, const Mold& mold, std::vector<Eigen::Vector3d> prescribed_boundary,
              double thickness, const ScoreOptions& options);

  [[nodiscard]] Eigen::Index size() const;
  /// What is a small difference of each field, in its unit: fields are compared by it.
  [[nodiscard]] Eigen::VectorXd scale() const;

  /// How the reference nodes lie in a mesh of the same ply: bilinear in the quadrilateral around each, or in
  /// the nearest one where the outline is cut differently.
  [[nodiscard]] Sampling sampling(const Mesh& mesh) const;
  /// @param sampling  of this mesh.  @param score  of this drape; valid.
  [[nodiscard]] std::vector<float> measure(const Mesh& mesh, const Sampling& sampling, const Snapshot& end,
                                           const Score& score) const;

  /// The objective of a ply with these fields: that of scoring.cpp up to the distance of the edge, which is
  /// taken at the nodes of the outline and of the boundary only.
  [[nodiscard]] double objective(const Eigen::VectorXd& fields) const;
  /// The same, ten times as fast, for plies whose edge is not far (some cells) from that of `fields`.
  [[nodiscard]] std::function<double(const Eigen::VectorXd&)> objective_near(
      const Eigen::VectorXd& fields) const;

 private:
  /// Per node of the outline the nearest node of the boundary, and the other way round.
  struct Neighbours {
    std::vector<int> on_boundary, on_edge;
  };
  [[nodiscard]] std::vector<Eigen::Vector3d> edge_of(const Eigen::VectorXd& fields) const;
  [[nodiscard]] Neighbours neighbours(const std::vector<Eigen::Vector3d>& edge) const;
  [[nodiscard]] double objective(const Eigen::VectorXd& fields, const Neighbours& near) const;

  Mesh reference_;
  const Mold& mold_;
  std::vector<Eigen::Vector3d> boundary_;
  double thickness_;
  ScoreOptions options_;
  std::vector<double> areas_;
  double area_ = 0;
};

}  // namespace drapeplan
