// The same in single precision. What is double in it must come from points.cpp: compiled here anew, its
// products could be contracted in another way, and a ply at rest would have forces.
#include "fem/shell/single.hpp"

namespace drapeplan {

extern template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 1, false>;
extern template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 1, true>;
extern template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 2, false>;
extern template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 2, true>;
template std::unique_ptr<Shell> make_single_shell_of<DRAPEPLAN_SECTION_POINTS>(const Mesh&, const Fabric&,
                                                                               const FemOptions&);

}  // namespace drapeplan
