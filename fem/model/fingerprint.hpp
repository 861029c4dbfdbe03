// A number that tells models apart.
#pragma once

#include <cstdint>

#include "fem/model/model.hpp"

namespace drapeplan {

/// Hash of all that a run depends on, its schedule aside: a saved state fits a model with the same one.
std::uint64_t fingerprint(const Model& model);

}  // namespace drapeplan
