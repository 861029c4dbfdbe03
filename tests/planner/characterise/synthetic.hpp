// Raw data of tests that nobody made: computed from a material that is known, with what spoils real data. So a
// characterisation can be held against the truth.
#pragma once

#include <filesystem>
#include <string>

#include "planner/case/fields.hpp"

namespace drapeplan::test {

/// What spoils the data, with a reason for each size.
struct Spoilt {
  double scatter = 0.01;            ///< of forces, from specimen to specimen (standard deviation)
  double force_noise = 0.02;        ///< of a 500 N load cell [N]
  double displacement_noise = 2e-7; ///< of a crosshead's encoder [m]
  double compliance = 1e-4;         ///< displacement of machine and clamps at 500 N, as [Krogh] measured [m]
  double slack = 2e-4;              ///< of a strip that is not straight in its clamps [m]
  double tip_noise = 2e-5;          ///< of a tip that is read from pictures [m]
  unsigned seed = 1;
};

/// Writes tests.json and its tables: tension at 0.5 and 2 mm/min (25 x 150 mm, five specimens each, three of
/// steel), bias extension at 2, 10 and 100 mm/min (120 x 270 mm, three specimens each), and cantilevers over a
/// minute: 25 pictures of one of 150 mm, tables of the tips of those of 100 and 70 mm (see synthetic_strip.hpp). What is not
/// tested is assumed to be as it is. Forces of bias extension are those of the balance of power, with half-sheared
/// zones at half of the rate.
/// @param truth  with the conjugate measure, and rates of compression.
void write_synthetic_tests(const std::filesystem::path& folder, const MaterialFields& truth,
                           const Spoilt& spoilt);

}  // namespace drapeplan::test
