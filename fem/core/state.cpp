#include "fem/core/state.hpp"

#include <algorithm>

#include "fem/core/hash.hpp"

namespace drapeplan {
namespace {

void add(Fnv1a& hash, const std::vector<double>& values, size_t count) {
  for (size_t k = 0; k < std::min(count, values.size()); ++k) hash.add(values[k]);
}

void add(Fnv1a& hash, const VectorField& field, size_t count) {
  add(hash, field.x, count);
  add(hash, field.y, count);
  add(hash, field.z, count);
}

}  // namespace

std::uint64_t hash_state(const State& state, int node_count) {
  const auto n = size_t(node_count);
  Fnv1a hash;
  hash.add(double(state.step));
  hash.add(state.time);
  hash.add(state.dt);
  hash.add(state.dt_before);
  hash.add(state.stable_dt);
  for (const VectorField* field :
       {&state.position, &state.velocity, &state.director, &state.director_rate, &state.anchor})
    add(hash, *field, n);
  add(hash, state.stuck, n);
  add(hash, state.history, state.history.size());
  for (const PadState& pad : state.pads) {
    for (int k = 0; k < 3; ++k) hash.add(pad.centre[k]);
    for (int k = 0; k < 4; ++k) hash.add(pad.rotation.coeffs()[k]);
    for (int k = 0; k < 3; ++k) hash.add(pad.velocity[k]);
    for (int k = 0; k < 3; ++k) hash.add(pad.angular_velocity[k]);
    if (pad.released) hash.add(1.0);
  }
  for (const double work : state.work) hash.add(work);
  return hash.value();
}

}  // namespace drapeplan
