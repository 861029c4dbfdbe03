#include "fem/terms/fibre_inertia.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

/// Of the mass, in each of the two passes along the warp: with a the mass over that of the nodes in some
/// mode, (1 + a/4)^2 is never below a, the most that stiffness over squared rate can be there.
constexpr double kWarpShare = 0.25;

}  // namespace

FibreInertia::Row::Row(const Nodes& of) : nodes(of) {
  consecutive = true;
  for (int l = 1; l < kLanes; ++l) consecutive = consecutive && nodes[size_t(l)] == nodes[0] + l;
}

Lanes FibreInertia::Row::load_from(const std::vector<double>& values) const {
  if (consecutive) return load(&values[size_t(nodes[0])]);
  return pick(values.data(), nodes);
}

Vec3<Lanes> FibreInertia::Row::load_from(const VectorField& field) const {
  return {load_from(field.x), load_from(field.y), load_from(field.z)};
}

void FibreInertia::Row::store_to(std::vector<double>& values, const Lanes& value) const {
  if (consecutive) return store(value, &values[size_t(nodes[0])]);
  for (size_t l = 0; l < size_t(kLanes); ++l) values[size_t(nodes[l])] = value[l];
}

FibreInertia::FibreInertia(const Mesh& mesh, const std::vector<char>& with_fibre_inertia, double stretch,
                           double rate, std::vector<double> mobility, std::vector<std::vector<int>> tied)
    : count_(mesh.node_count()),
      mobility_(std::move(mobility)),
      tied_(std::move(tied)),
      lines_{lines_of(mesh, with_fibre_inertia, 0), lines_of(mesh, with_fibre_inertia, 1)} {
  for (Lines& lines : lines_) {
    for (double& mass : lines.mass) mass *= stretch / (rate * rate);
  }
}

/// Masses per stretch / rate^2: with the fibre stretched differently at both edges, an element of length a
/// and width b is not stiffer than a spring b / (2 a) at each.
FibreInertia::Lines FibreInertia::lines_of(const Mesh& mesh, const std::vector<char>& with_fibre_inertia,
                                           int along) {
  const int count = mesh.node_count();
  Lines lines;
  lines.mass.assign(padded(count), 0.0);
  lines.ahead.assign(padded(count), count);
  std::vector<int> behind = lines.ahead;
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    if (!with_fibre_inertia[e]) continue;
    const auto& quad = mesh.quads[e];
    const Eigen::Vector2d size =
        (mesh.rest[size_t(quad[2])] - mesh.rest[size_t(quad[0])]).cwiseAbs();  // of a rectangle
    for (size_t c = 0; c < 4; ++c) {
      int from = quad[c], to = quad[(c + 1) % 4];
      const Eigen::Vector2d edge = mesh.rest[size_t(to)] - mesh.rest[size_t(from)];
      if (std::abs(edge[along]) < std::abs(edge[1 - along])) continue;
      if (edge[along] < 0) std::swap(from, to);
      lines.mass[size_t(from)] += 0.5 * size[1 - along] / size[along];
      lines.ahead[size_t(from)] = to;
      behind[size_t(to)] = from;
    }
  }
  order_sweeps(behind, lines);
  // A node without an edge may name any other, since its direction is zero: so most rows are consecutive.
  for (size_t n = 1; n < size_t(count); ++n) {
    const int after = lines.ahead[n - 1] + 1, before = behind[n - 1] + 1;
    if (lines.mass[n] == 0 && after < count) lines.ahead[n] = after;
    if (behind[n] == count && before < count && lines.mass[size_t(before)] == 0) behind[n] = before;
  }
  for (size_t n = 0; n < size_t(count); n += size_t(kLanes)) {
    const auto row = [n](const std::vector<int>& of) {
      Nodes nodes;
      std::copy_n(of.begin() + std::ptrdiff_t(n), size_t(kLanes), nodes.begin());
      return Row(nodes);
    };
    lines.ends.push_back(row(lines.ahead));
    lines.behind.push_back(row(behind));
  }
  return lines;
}

/// Lines in the order of their first nodes, kLanes side by side; shorter ones end in the edge that is none.
void FibreInertia::order_sweeps(const std::vector<int>& behind, Lines& lines) {
  const auto is_edge = [&lines](int n) { return lines.mass[size_t(n)] > 0; };
  std::vector<int> starts;
  const int none = behind.back();
  for (int n = 0; n < none; ++n) {
    if (is_edge(n) && behind[size_t(n)] == none) starts.push_back(n);
  }
  for (size_t first = 0; first < starts.size(); first += size_t(kLanes)) {
    lines.groups.push_back(lines.sweep.size());
    Nodes edges;
    for (size_t l = 0; l < size_t(kLanes); ++l)
      edges[l] = first + l < starts.size() ? starts[first + l] : none;
    while (std::any_of(edges.begin(), edges.end(), is_edge)) {
      lines.sweep.emplace_back(edges);
      for (int& edge : edges) {
        if (edge != none) edge = lines.ahead[size_t(edge)];
        if (!is_edge(edge)) edge = none;
      }
    }
  }
  lines.groups.push_back(lines.sweep.size());
}

FibreInertiaScratch FibreInertia::scratch() const {
  FibreInertiaScratch s;
  size_t longest = 0;
  for (size_t fibre = 0; fibre < kFibres; ++fibre) {
    const size_t size = (lines_[fibre].sweep.size() + 1) * size_t(kLanes);  // one row of zeros behind
    s.factors[fibre] = {std::vector<double>(size), std::vector<double>(size)};
    longest = std::max(longest, size);
  }
  s.sweep.resize(longest);
  s.pull.resize(mobility_.size());
  return s;
}

void FibreInertia::take_directions(State& state) const {
  for (size_t fibre = 0; fibre < kFibres; ++fibre) {
    const Lines& lines = lines_[fibre];
    VectorField& n = state.edges[fibre];
    for (size_t k = 0; k < size_t(count_); k += size_t(kLanes)) {
      const Vec3<Lanes> edge =
          lines.ends[k / size_t(kLanes)].load_from(state.position) - state.position.lanes(k);
      Lanes length, inverse;
      root_and_inverse(dot(edge, edge), length, inverse);
      std::experimental::where(load(&lines.mass[k]) == Lanes(0.0), inverse) = Lanes(0.0);
      Vec3<Lanes> unit = inverse * edge;
      n.set_lanes(k, unit);
    }
  }
}

void FibreInertia::factor(const State& state, FibreInertiaScratch& s) const {
  s.mobility = mobility_;
  for (size_t pad = 0; pad < tied_.size(); ++pad) {
    if (state.pads[pad].released) continue;
    for (const int node : tied_[pad]) s.mobility[size_t(node)] = 0;
  }
  factor(lines_[0], kWarpShare, state.edges[0], s.mobility, s.factors[0]);
  factor(lines_[1], 1, state.edges[1], s.mobility, s.factors[1]);
  s.ready = true;
}

void FibreInertia::factor(const Lines& lines, double share, const VectorField& n,
                          const std::vector<double>& mobility, FibreInertiaScratch::Factors& factors) {
  const auto direction = [&n](int k) { return Vec3<double>{n.x[size_t(k)], n.y[size_t(k)], n.z[size_t(k)]}; };
  for (size_t group = 0; group + 1 < lines.groups.size(); ++group) {
    for (size_t row = lines.groups[group]; row < lines.groups[group + 1]; ++row) {
      for (size_t l = 0; l < size_t(kLanes); ++l) {
        double &below = factors.below[row * size_t(kLanes) + l],
               &inverse = factors.inverse_pivot[row * size_t(kLanes) + l];
        const int k = lines.sweep[row].nodes[l];
        below = inverse = 0;
        if (lines.mass[size_t(k)] == 0) continue;
        const double here = mobility[size_t(k)], there = mobility[size_t(lines.ahead[size_t(k)])];
        double pivot = 1 / (share * lines.mass[size_t(k)]) + here + there;
        if (row > lines.groups[group]) {
          const double off = -here * dot(direction(lines.sweep[row - 1].nodes[l]), direction(k));
          below = off * factors.inverse_pivot[(row - 1) * size_t(kLanes) + l];
          pivot -= below * off;
        }
        inverse = 1 / pivot;
      }
    }
  }
}

DRAPEPLAN_FLATTEN void FibreInertia::pass(const Lines& lines, const FibreInertiaScratch::Factors& factors,
                                          const VectorField& n, FibreInertiaScratch& s,
                                          VectorField& force) const {
  for (size_t k = 0; k < size_t(count_); k += size_t(kLanes)) {
    const Row& ends = lines.ends[k / size_t(kLanes)];
    const Vec3<Lanes> apart =
        ends.load_from(s.mobility) * ends.load_from(force) - load(&s.mobility[k]) * force.lanes(k);
    store(dot(apart, n.lanes(k)), &s.pull[k]);
  }
  for (size_t group = 0; group + 1 < lines.groups.size(); ++group) {
    const size_t first = lines.groups[group], end = lines.groups[group + 1];
    Lanes value(0.0);
    for (size_t row = first; row < end; ++row) {
      const size_t at = row * size_t(kLanes);
      value = lines.sweep[row].load_from(s.pull) - load(&factors.below[at]) * value;
      store(value, &s.sweep[at]);
    }
    Lanes below(0.0);
    value = below;
    for (size_t row = end; row-- > first;) {
      const size_t at = row * size_t(kLanes);
      value = load(&factors.inverse_pivot[at]) * load(&s.sweep[at]) - below * value;
      below = load(&factors.below[at]);
      lines.sweep[row].store_to(s.pull, value);
    }
  }
  for (size_t k = 0; k < size_t(count_); k += size_t(kLanes)) {
    const Row& behind = lines.behind[k / size_t(kLanes)];
    force.set_lanes(
        k, force.lanes(k) + load(&s.pull[k]) * n.lanes(k) - behind.load_from(s.pull) * behind.load_from(n));
  }
}

void FibreInertia::filter(const State& state, FibreInertiaScratch& s, VectorField& force) const {
  const auto released = size_t(
      std::count_if(state.pads.begin(), state.pads.end(), [](const PadState& pad) { return pad.released; }));
  if (!s.ready || s.released != released) factor(state, s);
  s.released = released;
  for (const size_t fibre : {size_t(0), size_t(1), size_t(0)})
    pass(lines_[fibre], s.factors[fibre], state.edges[fibre], s, force);
}

}  // namespace drapeplan
