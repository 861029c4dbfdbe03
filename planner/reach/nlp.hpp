// The reach problem as a smooth nonlinear program with exact first and second derivatives; no solver in here.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "planner/reach/program.hpp"
#include "planner/reach/reach.hpp"

namespace drapeplan {

/// A vector function of (x, y) with its partial derivatives.
struct VectorJet {
  Eigen::Vector3d value, x, y, xx, xy, yy;

  [[nodiscard]] const Eigen::Vector3d& first(int a) const { return a == 0 ? x : y; }
  [[nodiscard]] const Eigen::Vector3d& second(int a, int b) const { return a != b ? xy : a == 0 ? xx : yy; }
};

/// Pad centre, mold normal and joint of a gripper whose pad lies at (x, y); lengths in units of `unit`.
struct GripperJet {
  VectorJet pad, normal, joint;
};

/// @param place   pad centre [unit];  @param offset  of the joint above the mold [unit];  @param unit  [m].
/// Needs the mold's derivatives up to third order. Not finite where the mold is not defined.
GripperJet gripper_jet(const Mold& mold, const Eigen::Vector2d& place, double offset, double unit);

enum class ReachGoal {
  rms,  ///< mean squared distance
  max,  ///< largest squared distance, as an extra variable (epigraph form)
};

/// Lengths are in units of the spacing. Variables: x, y of each pad; then the squared largest distance (goal
/// max); then the squared length of the interlinks (free links). Rows of the constraints: one per interlink,
/// two for the fixed joint, one per gripper for its tilt (limits below 90 degrees), one per gripper for its
/// distance (goal max).
class ReachNlp final : public SmoothProgram {
 public:
  /// `problem` must outlive the object and be sound (see check_reach).
  ReachNlp(const ReachProblem& problem, ReachGoal goal, bool free_links = false);

  [[nodiscard]] int variables() const { return variables_; }
  [[nodiscard]] int constraints() const { return rows_; }
  [[nodiscard]] Bounds variable_bounds() const;
  [[nodiscard]] Bounds constraint_bounds() const;
  /// All variables for given x-y places of the pads [m].
  [[nodiscard]] Eigen::VectorXd variables_at(const std::vector<Eigen::Vector2d>& places) const;
  /// x-y places of the pads [m].
  [[nodiscard]] std::vector<Eigen::Vector2d> places_at(const VectorRef& v) const;

  [[nodiscard]] Form form() const override;
  [[nodiscard]] double objective(const VectorRef& v, Eigen::VectorXd* gradient = nullptr) const override;
  [[nodiscard]] Eigen::VectorXd gradient(const VectorRef& v) const;
  [[nodiscard]] Eigen::VectorXd constraint_values(const VectorRef& v) const override;
  [[nodiscard]] const Pattern& jacobian_pattern() const { return jacobian_pattern_; }
  [[nodiscard]] Eigen::VectorXd jacobian_values(const VectorRef& v) const override;
  [[nodiscard]] const Pattern& hessian_pattern() const { return hessian_pattern_; }
  [[nodiscard]] Eigen::VectorXd hessian_values(const VectorRef& v, double sigma,
                                               const VectorRef& multipliers) const override;
  /// Largest violation of a constraint [spacing, or squares of it; the tilt's in its cosine].
  [[nodiscard]] double violation(const VectorRef& v) const;
  /// Length of the interlinks over the spacing: 1 unless they are free.
  [[nodiscard]] double link_scale(const VectorRef& v) const;

 private:
  [[nodiscard]] double link_length(size_t link) const;  ///< once closed [unit]
  [[nodiscard]] std::vector<GripperJet> jets(const VectorRef& v) const;
  [[nodiscard]] Eigen::Vector3d miss(const GripperJet& jet, int gripper) const;
  void build_patterns();

  const ReachProblem* problem_;
  ReachGoal goal_;
  bool free_links_, tilt_limited_;
  int count_;
  double unit_;
  std::vector<std::array<int, 2>> links_;
  int fixed_ = -1;                ///< index of the fixed gripper
  int level_ = -1, length_ = -1;  ///< places of the extra variables
  int fixed_row_, tilt_row_, level_row_;
  int variables_, rows_;
  Pattern jacobian_pattern_, hessian_pattern_;
};

}  // namespace drapeplan
