// The shell with DRAPEPLAN_SECTION_POINTS points over the section: compiled once for each number, so that
// compilers work side by side.
#include "fem/shell/term.hpp"

namespace drapeplan {

template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 1, false>;
template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 1, true>;
template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 2, false>;
template class ShellTerm<DRAPEPLAN_SECTION_POINTS, 2, true>;
template std::unique_ptr<Shell> make_shell_of<DRAPEPLAN_SECTION_POINTS>(const Mesh&, const Fabric&,
                                                                        const FemOptions&);

}  // namespace drapeplan
