#include "fem/model/fingerprint.hpp"

#include "fem/core/fields.hpp"

namespace drapeplan {
namespace {

/// A mold has no list of numbers of its own: heights tell molds apart, whatever their shape.
void add_mold(Fnv1a& hash, const Mold& mold) {
  // A spline may differ between the samples only.
  if (const auto* spline = std::get_if<SplineShape>(&mold.shape())) {
    for (const double value :
         {spline->origin.x(), spline->origin.y(), spline->spacing.x(), spline->spacing.y()})
      hash.add(value);
    for (const double value : spline->coefficients.reshaped()) hash.add(value);
  }
  constexpr int kSamples = 17;  // per side
  const Extent& extent = mold.extent();
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Eigen::Vector2d share(double(i) / (kSamples - 1), double(j) / (kSamples - 1));
      const Eigen::Vector2d at = extent.lower + share.cwiseProduct(extent.upper - extent.lower);
      for (const double value : {at.x(), at.y(), mold.height(at.x(), at.y())}) hash.add(value);
    }
  }
}

}  // namespace

std::uint64_t fingerprint(const Model& model) {
  Fnv1a hash;
  add_fields(hash, model.scene());
  if (model.scene().mold) add_mold(hash, *model.scene().mold);
  // What is derived from these has rules of its own, which change from version to version.
  add_fields(hash, model.masses().own_mass());
  add_fields(hash, model.masses().gyration2());
  add_fields(hash, model.masses().mass());
  add_fields(hash, model.stable_dt());
  add_fields(hash, model.alpha());
  add_fields(hash, model.term_names());
  return hash.value();
}

}  // namespace drapeplan
