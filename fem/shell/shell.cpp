#include "fem/shell/shell.hpp"

#include "fem/shell/single.hpp"
#include "fem/shell/term.hpp"
#include "mapping/error.hpp"

namespace drapeplan {

namespace {

template <int N>
std::unique_ptr<Shell> make_in_precision(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  return options.precision == Precision::single_lanes ? make_single_shell_of<N>(mesh, fabric, options)
                                                      : make_shell_of<N>(mesh, fabric, options);
}

}  // namespace

std::unique_ptr<Shell> make_shell(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  if (options.fibre_points != 1 && options.fibre_points != 2)
    throw WrongInput("shell: fibre_points must be 1 or 2");
  switch (options.section_points) {
    case 1:
      return make_in_precision<1>(mesh, fabric, options);
    case 3:
      return make_in_precision<3>(mesh, fabric, options);
    case 5:
      return make_in_precision<5>(mesh, fabric, options);
    default:
      throw WrongInput("shell: section_points must be 1, 3 or 5");
  }
}

}  // namespace drapeplan
