// The shell in single precision with five points over the section.
#include "fem/shell_single.hpp"

namespace drapeplan {

extern template class ShellTerm<5, 1, false>;
extern template class ShellTerm<5, 1, true>;
extern template class ShellTerm<5, 2, false>;
extern template class ShellTerm<5, 2, true>;

template std::unique_ptr<Shell> make_single_shell_of<5>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
