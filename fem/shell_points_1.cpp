// The shell with one point over the section.
#include "fem/shell_term.hpp"

namespace drapeplan {

template std::unique_ptr<Shell> make_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
