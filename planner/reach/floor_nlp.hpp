// The floor of a ply as a smooth nonlinear program with exact first and second derivatives; no solver in
// here.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "planner/reach/floor.hpp"
#include "planner/reach/program.hpp"

namespace drapeplan {

/// A piece of fibre: f = sum of coefficient * place of corner over `count` corners; its flat length is 1.
struct Fibre {
  int count = 2;  ///< 2: an edge of the net; 4: the mean of a cell
  std::array<int, 4> corner{0, 0, 0, 0};
  std::array<double, 4> coefficient{0, 0, 0, 0};  ///< [1/m]
  bool weft = false;
  double length = 0;  ///< flat [m]
};

/// All fibres of the net that are not held by a single pad: edges along warp and weft between two cells, and
/// warp and weft in the middle of each cell that has a node on the outline or an edge across the fibres. (The
/// outline itself may bend in its plane: drapes have strains there that twice exceed those of their cells.)
std::vector<Fibre> fibres_of(const FloorProblem& problem);

/// Signed distance from the mold with its derivatives by the place, in units of `unit`.
struct DistanceJet {
  double value;
  Eigen::Vector3d first;
  Eigen::Matrix3d second;
};

/// @param place  [unit];  @param unit  [m]. Not finite where the closest point is not found.
DistanceJet distance_jet(const Mold& mold, const Eigen::Vector3d& place, double unit);

/// Weight of mean square gap and distance from the mapped net against the largest gap, all in units of the
/// spacing. With means of (5 mm)^2 and a spacing of 100 mm the optimum moves by less than 0.3 um.
inline constexpr double kRegularisation = 1e-3;

/// What holds a floor up, the most important first.
/// @param multipliers  of the rows of `fibres`, first in the program; >= 0 but for round-off.
std::vector<TautSpan> taut_spans(const FloorProblem& problem, const std::vector<Fibre>& fibres,
                                 const std::vector<Eigen::Vector3d>& nodes,
                                 const Eigen::VectorXd& multipliers);

/// Edge node `node` must satisfy lower <= direction . (x - place) <= upper.
struct EdgeLimit {
  int node = 0;
  Eigen::Vector3d direction{0, 0, 0};  ///< unit
  Eigen::Vector3d place{0, 0, 0};      ///< [m]
  double lower = 0, upper = 0;         ///< [m]
};

/// A net with its pads.
struct FloorShape {
  std::vector<Eigen::Vector2d> xy;               ///< foot of each node on the mold; unused for held nodes [m]
  std::vector<double> gap;                       ///< of each node [m]
  std::vector<Eigen::Vector3d> pad, warp, weft;  ///< centre [m] and in-plane unit vectors of each pad
};

/// Lengths are in units of the spacing. A free node lies at P(x, y) + (g + h / 2) n(x, y) with the mold's
/// point P and normal n, the gap g and the thickness h; a held one at c + xi a + eta b with its pad's centre
/// c and unit vectors a, b. Variables: x, y, g of each free node or g of a held one, in the order of the
/// nodes; c, a, b and the joint q of each pad; the largest gap t. Minimised: t plus a small multiple of the
/// net's mean square gap and in-plane distance from the mapped net, which makes the solution unique. Rows:
/// one per fibre; per node g <= t; per held node that g is its distance from the mold; per pad three of its
/// unit vectors, three of its joint and one of its tilt; per interlink; per edge limit.
class FloorNlp final : public SmoothProgram {
 public:
  /// `problem` and `limits` must outlive the object.
  FloorNlp(const FloorProblem& problem, const std::vector<EdgeLimit>& limits);

  [[nodiscard]] Eigen::VectorXd variables_at(const FloorShape& shape) const;
  [[nodiscard]] FloorShape shape_at(const VectorRef& v) const;
  /// Mid-surface [m].
  [[nodiscard]] std::vector<Eigen::Vector3d> nodes_at(const VectorRef& v) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> joints_at(const VectorRef& v) const;
  /// Largest gap t [m].
  [[nodiscard]] double largest_gap(const VectorRef& v) const { return v[level_] * unit_; }
  [[nodiscard]] const std::vector<Fibre>& fibres() const { return fibres_; }
  [[nodiscard]] double unit() const { return unit_; }

  [[nodiscard]] Form form() const override;
  [[nodiscard]] double objective(const VectorRef& v, Eigen::VectorXd* gradient) const override;
  [[nodiscard]] Eigen::VectorXd constraint_values(const VectorRef& v) const override;
  [[nodiscard]] Eigen::VectorXd jacobian_values(const VectorRef& v) const override;
  [[nodiscard]] Eigen::VectorXd hessian_values(const VectorRef& v, double sigma,
                                               const VectorRef& multipliers) const override;

 private:
  /// A node's place as a function of its variables: of x, y, g, or of c, a, b.
  struct NodeJet {
    Eigen::Vector3d value;
    Eigen::Matrix3d first;                  ///< by x, y, g; not of held nodes
    std::array<Eigen::Vector3d, 6> second;  ///< xx, yx, yy, gx, gy, gg; not of held nodes
  };
  struct Sums;
  struct Rows {
    int level = 0, gap = 0, frame = 0, joint = 0, tilt = 0, link = 0, limit = 0, count = 0;
  };

  [[nodiscard]] bool is_held(int node) const { return pad_[size_t(node)] >= 0; }
  [[nodiscard]] int gap_of(int node) const { return first_[size_t(node)] + (is_held(node) ? 0 : 2); }
  /// Variables of the pad: c at 0, a at 3, b at 6, q at 9.
  [[nodiscard]] int pad_at(int pad) const { return first_pad_ + 12 * pad; }
  /// Weights of c, a and b in a held node's place [-, spacing, spacing].
  [[nodiscard]] Eigen::Vector3d weights(int node) const;
  [[nodiscard]] Eigen::Vector3d fibre(const Fibre& of, const std::vector<NodeJet>& all) const;
  [[nodiscard]] std::vector<NodeJet> jets(const VectorRef& v) const;
  [[nodiscard]] Eigen::Vector3d held_place(const VectorRef& v, int node) const;
  /// d(row)/d(node's variables) for a row whose derivative by the node's place is `by_place`.
  template <class Sink>
  void add_place(Sink& sink, int row, int node, const NodeJet& jet, const Eigen::Vector3d& by_place) const;
  template <class Sink>
  void jacobian(const VectorRef& v, Sink& sink) const;
  template <class Sink>
  void jacobian_of_rig(const VectorRef& v, Sink& sink) const;
  template <class Sink>
  void add_fibres(Sink& sink, const VectorRef& multipliers, const std::vector<NodeJet>& all,
                  Sums& sums) const;
  template <class Sink>
  void add_nodes(Sink& sink, double sigma, const VectorRef& multipliers, const std::vector<NodeJet>& all,
                 Sums& sums) const;
  template <class Sink>
  void add_pads(Sink& sink, const VectorRef& multipliers, Sums& sums) const;
  template <class Sink>
  void add_links(Sink& sink, const VectorRef& multipliers) const;
  template <class Sink>
  void hessian(const VectorRef& v, double sigma, const VectorRef& multipliers, Sink& sink) const;
  template <class Sink>
  void add_pair(Sink& sink, int p, int q, const std::vector<NodeJet>& all, double weight) const;

  void build_patterns();

  const FloorProblem* problem_;
  const std::vector<EdgeLimit>* limits_;
  double unit_, half_;  ///< [m]; half the thickness [unit]
  std::vector<Fibre> fibres_;
  std::vector<int> pad_;  ///< that holds the node, or -1
  std::vector<std::array<int, 2>> links_;
  std::vector<int> first_;  ///< variable of each node
  int nodes_ = 0, pads_ = 0, held_ = 0, first_pad_ = 0, level_ = 0, variables_ = 0;
  bool tilt_limited_;
  Rows row_;
  Pattern jacobian_pattern_, hessian_pattern_;
};

}  // namespace drapeplan
