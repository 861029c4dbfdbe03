// In place of fem/terms/fibre_inertia.cpp.
#include "fem/terms/fibre_inertia.hpp"

#include "tests/bench/absent/absent.hpp"

namespace drapeplan {
namespace {

constexpr const char* kInertia = "fibre inertia";

}  // namespace

FibreInertia::FibreInertia(const Mesh& /*mesh*/, const std::vector<char>& /*with_fibre_inertia*/,
                           double /*stretch*/, double /*rate*/, std::vector<double> /*mobility*/,
                           std::vector<std::vector<int>> /*tied*/)
    : count_(0) {
  absent(kInertia);
}
FibreInertiaScratch FibreInertia::scratch() const {
  absent(kInertia);
}
void FibreInertia::take_directions(State& /*state*/) const {
  absent(kInertia);
}
void FibreInertia::filter(const State& /*state*/, FibreInertiaScratch& /*scratch*/,
                          VectorField& /*force*/) const {
  absent(kInertia);
}

}  // namespace drapeplan
