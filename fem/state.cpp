#include "fem/state.hpp"

#include <bit>

namespace drapeplan {
namespace {

class Fnv1a {
 public:
  void add(double value) {
    auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) {
      hash_ = (hash_ ^ (bits & 0xff)) * 0x100000001b3ULL;
    }
  }
  void add(const std::vector<double>& values, size_t count) {
    for (size_t k = 0; k < std::min(count, values.size()); ++k) add(values[k]);
  }
  void add(const VectorField& field, size_t count) {
    add(field.x, count);
    add(field.y, count);
    add(field.z, count);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::uint64_t hash_state(const State& state, int node_count) {
  const auto n = size_t(node_count);
  Fnv1a hash;
  hash.add(double(state.step));
  hash.add(state.time);
  for (const VectorField* field : {&state.x, &state.v, &state.d, &state.w, &state.anchor}) hash.add(*field, n);
  hash.add(state.stuck, n);
  for (const PadState& pad : state.pads) {
    for (int k = 0; k < 3; ++k) hash.add(pad.centre[k]);
    for (int k = 0; k < 4; ++k) hash.add(pad.rotation.coeffs()[k]);
    for (int k = 0; k < 3; ++k) hash.add(pad.velocity[k]);
    for (int k = 0; k < 3; ++k) hash.add(pad.angular_velocity[k]);
  }
  for (const double work : state.work) hash.add(work);
  return hash.value();
}

}  // namespace drapeplan
