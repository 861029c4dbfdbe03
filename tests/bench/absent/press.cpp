// In place of fem/terms/press.cpp.
#include "fem/terms/press.hpp"

#include "tests/bench/absent/absent.hpp"

namespace drapeplan {

void check_press(const Press& /*press*/) {
  absent("press");
}

PressTimes press_times(const Press& /*press*/, const Schedule* /*schedule*/, double /*end*/) {
  absent("press");
}

double pressure_at(const PressTimes& /*times*/, double /*full*/, double /*t*/) {
  absent("press");
}

std::unique_ptr<Term> make_press(const Press& /*press*/, const Mesh& /*mesh*/) {
  absent("press");
}

}  // namespace drapeplan
