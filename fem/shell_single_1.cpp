// The shell in single precision with one point over the section.
#include "fem/shell_single.hpp"

namespace drapeplan {

extern template class ShellTerm<1, 1, false>;
extern template class ShellTerm<1, 1, true>;
extern template class ShellTerm<1, 2, false>;
extern template class ShellTerm<1, 2, true>;

template std::unique_ptr<Shell> make_single_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
