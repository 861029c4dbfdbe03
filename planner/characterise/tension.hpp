// Tension tests: stress along the fibres over their strain. [Krogh], "Tension Test".
#pragma once

#include <string>
#include <vector>

#include "fem/law/fabric.hpp"
#include "planner/tables/smooth.hpp"
#include "planner/measured/tests_file.hpp"

namespace drapeplan {

/// Measured points of one specimen, as stress over strain.
struct StrainPoints {
  std::string file;
  double rate = 0;  ///< of strain [1/s]
  std::vector<double> strain, stress;
};

struct TensionLaw {
  Curve curve;                          ///< at the fastest rate, nominal
  double rate = 0;                      ///< of strain [1/s]
  double band = 0;                      ///< r.m.s. of what specimens differ from it, of the largest stress
  double valid_to = 0;                  ///< largest strain that all of its specimens reached
  std::vector<StrainPoints> specimens;  ///< of all rates, without the machine's part and the toe
};

/// Displacement of machine and clamps over the force, from tests of a stiff specimen; their mean. Its own
/// elongation is neglected ([Krogh], Eq. (6): 0.0012 mm of 0.1 mm).
/// @param tests  at least one.
MonotoneCubic machine_displacement(const std::vector<ComplianceTest>& tests);

/// [Krogh], Eq. (7), of the forces and displacements without those of the machine. The toe, in which a
/// specimen is not straight yet, is left out: the displacement at which the force begins is found from
/// displacement = begin + c force^(1/p), fitted to the lower forces.
/// @param thickness  of the ply [m].
/// @throws NotFinished with the file if a specimen carries no force.
TensionLaw tension_law(const std::vector<StripTest>& tests, const std::vector<ComplianceTest>& compliance,
                       double thickness);

}  // namespace drapeplan
