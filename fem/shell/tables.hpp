// What the shell knows before its first step: the fabric's curves as tables, rest geometry of elements.
#pragma once

#include "fem/core/options.hpp"
#include "fem/law/fabric.hpp"
#include "fem/law/rates.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/shell/kernel.hpp"

namespace drapeplan {

/// The fabric's slowest curves, resampled; hourglass moduli by the options.
KernelMaterial kernel_material(const Fabric& fabric, const FemOptions& options);

/// Curves by strain and rate.
RateTables rate_tables(const Fabric& fabric);

/// @throws WrongInput if the element's area is not positive.
ElementGeometry<double> element_geometry(const Mesh& mesh, const std::array<int, 4>& quad);

}  // namespace drapeplan
