// In place of fem/shell/shell.cpp, fem/shell/points_*.cpp and fem/law/rates.cpp: shells without rates only.
#include <stdexcept>

#include "fem/shell/term.hpp"
#include "tests/bench/absent/absent.hpp"

namespace drapeplan {
namespace {

template <int N>
std::unique_ptr<Shell> without_rates(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  if (options.fibre_points == 1) return std::make_unique<ShellTerm<N, 1, false>>(mesh, fabric, options);
  return std::make_unique<ShellTerm<N, 2, false>>(mesh, fabric, options);
}

}  // namespace

std::unique_ptr<Shell> make_shell(const Mesh& mesh, const Fabric& fabric, const FemOptions& options) {
  if (options.rates && fabric.rate_dependent()) absent("rates");
  if (options.section_points == 1) return without_rates<1>(mesh, fabric, options);
  if (options.section_points == 3) return without_rates<3>(mesh, fabric, options);
  if (options.section_points == 5) return without_rates<5>(mesh, fabric, options);
  absent("such number of section points");
}

RateLookup::RateLookup(const std::function<double(double, double)>& /*f*/, double /*lower*/, double /*upper*/,
                       int /*intervals*/, double /*floor*/, double /*fastest*/) {
  absent("rates");
}

}  // namespace drapeplan
