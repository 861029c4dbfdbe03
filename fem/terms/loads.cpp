#include "fem/terms/loads.hpp"

#include <fmt/format.h>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

class LoadsTerm final : public Term {
 public:
  LoadsTerm(const Loads& loads, const std::vector<double>& area)
      : moments_(loads.moments), force_(int(area.size())) {
    for (size_t n = 0; n < area.size(); ++n) add(n, area[n] * loads.pressure);
    for (const NodalLoad& load : loads.forces) add(size_t(load.node), load.value);
  }

  [[nodiscard]] std::string_view name() const override { return "loads"; }

  [[nodiscard]] std::vector<Forces> entries() const override {
    VectorField moment;
    if (!moments_.empty()) moment = force_;
    moment.fill(0);
    return {{Book::load, force_, std::move(moment)}};  // the forces are constant: written once here
  }

  /// Forces do not depend on the shape. The derivative of M x d by d is no larger than |M|.
  void add_stiffness(NodalStiffness& stiffness) const override {
    for (const NodalLoad& load : moments_) stiffness.rotation[size_t(load.node)] += load.value.norm();
  }

  void forces(State& state, Forces* entries) const override {
    VectorField& moment = entries->moment;
    for (const NodalLoad& load : moments_) {
      const auto n = size_t(load.node);
      moment.x[n] = moment.y[n] = moment.z[n] = 0;
    }
    for (const NodalLoad& load : moments_) {
      const auto n = size_t(load.node);
      const Eigen::Vector3d m =
          load.value.cross(Eigen::Vector3d(state.director.x[n], state.director.y[n], state.director.z[n]));
      moment.x[n] += m.x();
      moment.y[n] += m.y();
      moment.z[n] += m.z();
    }
  }

 private:
  void add(size_t n, const Eigen::Vector3d& value) {
    force_.x[n] += value.x();
    force_.y[n] += value.y();
    force_.z[n] += value.z();
  }

  std::vector<NodalLoad> moments_;
  VectorField force_;
};

}  // namespace

std::unique_ptr<Term> make_loads(const Loads& loads, const std::vector<double>& area) {
  for (const auto* list : {&loads.forces, &loads.moments}) {
    for (const NodalLoad& load : *list) {
      if (load.node < 0 || size_t(load.node) >= area.size() || !load.value.allFinite()) {
        throw WrongInput(fmt::format("loads: node {} does not exist or its load is not finite", load.node));
      }
    }
  }
  if (!loads.pressure.allFinite()) throw WrongInput("loads: the pressure is not finite");
  return std::make_unique<LoadsTerm>(loads, area);
}

}  // namespace drapeplan
