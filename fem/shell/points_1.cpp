// The shell with one point over the section, in double and in single precision.
#include "fem/shell/single.hpp"

namespace drapeplan {

template class ShellTerm<1, 1, false>;
template class ShellTerm<1, 1, true>;
template class ShellTerm<1, 2, false>;
template class ShellTerm<1, 2, true>;
template std::unique_ptr<Shell> make_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);
template std::unique_ptr<Shell> make_single_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
