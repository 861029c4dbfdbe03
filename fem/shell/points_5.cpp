// The shell with five points over the section, in double and in single precision.
#include "fem/shell/single.hpp"

namespace drapeplan {

template class ShellTerm<5, 1, false>;
template class ShellTerm<5, 1, true>;
template class ShellTerm<5, 2, false>;
template class ShellTerm<5, 2, true>;
template std::unique_ptr<Shell> make_shell_of<5>(const Mesh&, const Fabric&, const FemOptions&);
template std::unique_ptr<Shell> make_single_shell_of<5>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
