// Fibre inertia: inertia of the stretch of fibres alone, which alone sets the step.
//
// Every edge of a rectangle along a fibre gets a mass mu that resists the relative acceleration of its two
// nodes along it, n.(a_2 - a_1), and nothing else: falling, sliding, turning, bending and shearing stay as
// they are. With B the rows n (delta_2 - delta_1) of all edges of one fibre and W = 1 / mass of nodes, the
// forces f become
//
//   f - B^T (1/mu + B W B^T)^-1 B W f,
//
// which is (mass + B^T mu B) W f by Woodbury's identity, without forming it: 1/mu + B W B^T is tridiagonal
// along each mesh line. Both fibres follow each other: a share of warp, weft, the same share of
// warp, so that the mass matrix is symmetric; without the second pass it is not, and drapes blow up within a
// few thousand steps.
//
// Source of the idea: fibre inertia by a stiffness-proportional part of the mass matrix (Olovsson,
// Simonsson, Unosson 2005); by lines and along fibres only: own.
#pragma once

#include <array>
#include <vector>

#include "fem/core/state.hpp"
#include "fem/mesh/mesh.hpp"

namespace drapeplan {

struct FibreInertiaScratch {
  /// LDL^T of one fibre's systems, in the order of sweeps.
  struct Factors {
    std::vector<double> below, inverse_pivot;
  };
  bool ready = false;            ///< factors belong to the directions in the state
  size_t released = 0;           ///< pads that held nothing when these were made
  std::vector<double> mobility;  ///< of nodes now, 0 under a pad that holds them [1/kg, padded]
  std::array<Factors, 2> factors;
  std::vector<double> pull;   ///< of edges, by first node: relative acceleration, then tension [padded]
  std::vector<double> sweep;  ///< of edges, in the order of sweeps
};

class FibreInertia {
 public:
  /// @param with_fibre_inertia     by element: its edges get mass; rectangles along the fibres only
  /// @param stretch   steepest force per width and strain of a fibre [N/m]
  /// @param rate      highest rate that the stretch of an edge may have [1/s]
  /// @param mobility  1 / mass of nodes that are on their own, 0 where they are held [1/kg, padded]
  /// @param tied      nodes of each pad: while it holds them, an edge there pulls as if the pad did not
  ///                  accelerate, which is not quite symmetric: see tests/bench/fem.md for what that limits
  FibreInertia(const Mesh& mesh, const std::vector<char>& with_fibre_inertia, double stretch, double rate,
               std::vector<double> mobility, std::vector<std::vector<int>> tied);

  [[nodiscard]] FibreInertiaScratch scratch() const;
  /// Takes the directions of edges from the state's positions into state.edges.
  void take_directions(State& state) const;
  /// Adds to the sums of all forces what the added mass exerts on the nodes.
  void filter(const State& state, FibreInertiaScratch& scratch, VectorField& force) const;

 private:
  static constexpr size_t kFibres = 2;
  using Nodes = std::array<int, size_t(kLanes)>;

  /// Nodes of lanes; most follow each other.
  struct Row {
    Nodes nodes;
    bool consecutive = false;
    explicit Row(const Nodes& of);
    [[nodiscard]] Lanes load_from(const std::vector<double>& values) const;
    [[nodiscard]] Vec3<Lanes> load_from(const VectorField& field) const;
    void store_to(std::vector<double>& values, const Lanes& value) const;
  };

  /// The edges of one fibre, named by their first nodes; a node has one at most.
  struct Lines {
    std::vector<double> mass;       ///< added [kg]; 0: no edge [padded]
    std::vector<int> ahead;         ///< node at the end of the edge that starts here
    std::vector<Row> ends, behind;  ///< by block of nodes: these; first nodes of the edges that end here
    std::vector<Row> sweep;         ///< edges in rows: one of each of kLanes lines side by side
    std::vector<size_t> groups;     ///< first row of each group of lines, and the end
  };

  static Lines lines_of(const Mesh& mesh, const std::vector<char>& with_fibre_inertia, int along);
  static void order_sweeps(const std::vector<int>& behind, Lines& lines);
  void factor(const State& state, FibreInertiaScratch& scratch) const;
  static void factor(const Lines& lines, double share, const VectorField& n,
                     const std::vector<double>& mobility, FibreInertiaScratch::Factors& factors);
  void pass(const Lines& lines, const FibreInertiaScratch::Factors& factors, const VectorField& n,
            FibreInertiaScratch& scratch, VectorField& force) const;

  int count_;  ///< of nodes; also the name of no edge: its mass and direction are zero
  std::vector<double> mobility_;
  std::vector<std::vector<int>> tied_;
  std::array<Lines, kFibres> lines_;
};

}  // namespace drapeplan
