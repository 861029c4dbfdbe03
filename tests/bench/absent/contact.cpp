// In place of fem/terms/contact.cpp.
#include "fem/terms/contact.hpp"

#include "tests/bench/absent/absent.hpp"

namespace drapeplan {

std::unique_ptr<Term> make_contact(const Mold& /*mold*/, std::optional<double> /*friction*/,
                                   ContactSprings /*springs*/, double /*surface*/, int /*look_ahead*/,
                                   ReleasedSprings /*released*/, std::optional<NodalTack> /*tack*/) {
  absent("contact");
}

std::unique_ptr<Term> make_gravity(const std::vector<double>& /*mass*/, double /*acceleration*/) {
  absent("gravity");
}

}  // namespace drapeplan
