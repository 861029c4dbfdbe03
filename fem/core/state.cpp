#include "fem/core/state.hpp"

#include <algorithm>

#include "fem/core/hash.hpp"

namespace drapeplan {
namespace {

/// Adds what it visits to a hash.
class Hasher {
 public:
  explicit Hasher(int node_count) : nodes_(size_t(node_count)) {}

  void operator()(const auto& field, Hashed part) {
    if (part != Hashed::no) add(field, part);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_.value(); }

 private:
  void add(double number, Hashed /*part*/) { hash_.add(number); }
  void add(std::int64_t number, Hashed /*part*/) { hash_.add(double(number)); }
  void add(const std::vector<double>& list, Hashed part) {
    const size_t count = part == Hashed::nodes ? std::min(nodes_, list.size()) : list.size();
    for (size_t k = 0; k < count; ++k) hash_.add(list[k]);
  }
  void add(const VectorField& field, Hashed part) {
    for (const auto* list : {&field.x, &field.y, &field.z}) add(*list, part);
  }
  void add(const RunRecord& record, Hashed /*part*/) {
    visit_fields(record, [this](double figure) { hash_.add(figure); });
  }
  void add(const PadState& pad, Hashed /*part*/) {
    visit_fields(pad, [this](const auto& field) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, bool>) {
        if (field) hash_.add(1.0);
      } else {
        for (const double number : field) hash_.add(number);
      }
    });
  }
  template <class T, size_t kSize>
  void add(const std::array<T, kSize>& list, Hashed part) {
    for (const T& item : list) add(item, part);
  }
  void add(const std::vector<PadState>& pads, Hashed part) {
    for (const PadState& pad : pads) add(pad, part);
  }

  Fnv1a hash_;
  size_t nodes_;
};

}  // namespace

std::uint64_t hash_state(const State& state, int node_count) {
  Hasher hasher(node_count);
  visit_fields(state, [&hasher](const auto& field, Hashed part) { hasher(field, part); });
  return hasher.value();
}

}  // namespace drapeplan
