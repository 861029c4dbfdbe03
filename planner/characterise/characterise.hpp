// From tests to a material: the laws of all modes, the material file, and how well it plays the tests again.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/characterise/beam.hpp"
#include "planner/characterise/bending.hpp"
#include "planner/characterise/shear.hpp"
#include "planner/characterise/tension.hpp"
#include "planner/characterise/verify.hpp"
#include "planner/measured/strip_shape.hpp"

namespace drapeplan {

/// A cantilever in time, and what its slopes at the clamp say.
struct StripHistory {
  std::string file;                    ///< of its tip, or of its last picture
  TipHistory tips;
  std::vector<StripShape> shapes;      ///< of pictures
  std::vector<double> root_strain;     ///< at their times, outside at 0.1 % of the length, > 0 [-]
  std::vector<double> shear_modulus;   ///< at the times of the shapes, Eq. (14) [Pa]
};

/// The bending law of a strip from its shape at rest, see bending_law_of_profile.
struct ProfileLaw {
  std::string file;
  double length = 0;  ///< [m]
  double drop = 0;    ///< of the tip [m]
  BendingLaw law;     ///< curvature [1/m] over moment per width [N]
  /// The law of the material that was found, at rest, up to the same moment; empty where its fibres have no curves.
  BendingLaw material;
  double material_drop = 0;  ///< of the strip with that law [m]
};

struct Characterisation {
  std::optional<TensionLaw> tension;
  std::optional<ShearLaw> bias;   ///< from bias extension
  std::optional<ShearLaw> frame;  ///< from picture frames
  std::vector<StripHistory> strips;   ///< of all cantilevers that were seen in time
  std::vector<ProfileLaw> profiles;   ///< of those whose shape at rest was measured
  std::optional<CompressionLaw> compression;  ///< from the first of `strips`
  MaterialFields material;        ///< shear: of the bias extension if there is one, else of the frames
  /// Of tension and bias extension one specimen of each rate that gave a curve, and all `strips`.
  std::vector<Verification> verifications;
};

/// @param tests  read without errors.  @param threads  for the runs that verify.
/// @param progress  called with what is being done; may be empty.
/// @throws WrongInput if a mode is neither tested nor assumed, or tests of one kind do not fit together;
/// NotFinished if data hold no curve.
Characterisation characterise(const Tests& tests, int threads,
                              const std::function<void(const std::string&)>& progress = {});

/// The material as a material file holds it.
nlohmann::json material_json(const MaterialFields& material);

}  // namespace drapeplan
