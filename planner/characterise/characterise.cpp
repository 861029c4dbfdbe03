#include "planner/characterise/characterise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/characterise/beam.hpp"
#include "planner/case/section_fields.hpp"
#include "planner/input/writer.hpp"

namespace drapeplan {
namespace {

constexpr double kToDegrees = 180 / std::numbers::pi;

/// Speeds of the crosshead, each once: "2, 10 and 100 mm/min".
template <class Test>
std::string speeds(const std::vector<Test>& tests) {
  std::set<double> all;
  for (const Test& test : tests) all.insert(std::round(6e7 * test.rate) / 1e3);
  return fmt::format("{} mm/min", fmt::join(all, ", "));
}

std::string specimens(size_t count) {
  return fmt::format("{} specimen{}", count, count == 1 ? "" : "s");
}

CurveFields tension_fields(const TensionLaw& law, const Tests& tests) {
  CurveFields fields;
  fields.curve = law.curve;
  fields.valid_to = law.valid_to;
  fields.band = law.band;
  fields.source = fmt::format(
      "Tension of {} at {}; the curve is that of the fastest rate, {:.2g} 1/s{}. Measured up to {:.3g} %; "
      "specimens differ from it by {:.2g} % of its largest stress (r.m.s.)",
      specimens(tests.tension.size()), speeds(tests.tension), law.rate,
      tests.compliance.empty() ? ", with the displacement of the machine in it"
                               : ", without the displacement of the machine",
      1e2 * law.valid_to, 1e2 * law.band);
  return fields;
}

CurveFields shear_fields(const ShearLaw& law, const std::string& what) {
  CurveFields fields;
  fields.curve = law.table.curves.front();
  fields.valid_to = law.valid_to;
  fields.band = law.band;
  if (law.table.rate_dependent()) {
    for (size_t k = 0; k < law.table.rates.size(); ++k)
      fields.rates.push_back({law.table.rates[k], 1, law.table.curves[k], {}});
  }
  fields.source = fmt::format("{}. Measured up to {:.3g} deg, angles hold to {:.3g} deg; specimens differ from "
                              "their mean by {:.2g} % of the force (r.m.s.)",
                              what, kToDegrees * law.measured_to, kToDegrees * law.valid_to, 1e2 * law.band);
  return fields;
}

/// The strip's history: of pictures its shapes, of a table its drops.
StripHistory history_of(const CantileverTest& test, const Tests& tests) {
  constexpr double kRoot = 0.001;  // of the length, where [Krogh] takes the strain
  const double load = tests.gravity * tests.areal_density;
  StripHistory history;
  history.tips.length = test.length;
  history.tips.width = test.width;
  history.file = test.file.empty() ? test.frames.back().file : test.file;
  for (const StripFrame& frame : test.frames) {
    const StripShape shape = strip_shape(frame.line, frame.time);
    history.shapes.push_back(shape);
    history.tips.time.push_back(frame.time);
    history.tips.tip.push_back(shape.tip());
    history.root_strain.push_back(outer_strain(shape, kRoot, tests.thickness));
    history.shear_modulus.push_back(
        transverse_shear_modulus(shape.slope(0), test.length, load, tests.thickness));
  }
  for (size_t k = 0; k < test.table.rows(); ++k) {
    const double tip = test.table[TestQuantity::deflection][k];
    if (!(tip > 0 && tip < test.length)) continue;
    history.tips.time.push_back(test.table[TestQuantity::time][k]);
    history.tips.tip.push_back(tip);
  }
  return history;
}

/// Moment against curvature from a strip's shape at rest, beside the law of the material that was found.
ProfileLaw profile_law_of(const CantileverTest& test, const Tests& tests, const Fabric& fabric) {
  constexpr size_t kRowsPerPiece = 4, kMostPieces = 8;  // of the law: more pieces would follow noise
  const std::vector<double>&x = test.table[TestQuantity::distance], &down = test.table[TestQuantity::deflection];
  std::vector<Eigen::Vector2d> places;
  for (size_t k = 0; k < x.size(); ++k) places.emplace_back(x[k] - x.front(), down.front() - down[k]);
  const double load = tests.gravity * tests.areal_density;
  ProfileLaw result;
  result.file = test.profile;
  result.length = test.length;
  result.drop = -places.back().y();
  result.law = bending_law_of_profile(places, load, int(std::min(x.size() / kRowsPerPiece, kMostPieces)));
  const BendingLaw material =
      section_bending(fabric.tension.slowest(), fabric.compression.slowest(), fabric.thickness);
  if (material.strain.size() < 2) return result;
  result.material_drop = strip_at_rest(material, test.length, load).tip();
  for (const double moment : result.law.strain) {
    result.material.strain.push_back(moment);
    result.material.stress.push_back(material(moment));
  }
  return result;
}

CurveFields compression_fields(const CompressionLaw& law, const StripHistory& strip, const Tests& tests) {
  CurveFields fields;
  fields.curve = law.master;
  fields.valid_to = law.largest_strain;
  for (size_t k = 0; k < law.factors.size(); ++k)
    fields.rates.push_back({law.rates[k], law.factors[k], {}, {}});
  fields.source = fmt::format(
      "Inverse bending model: the master curve has the slope of tension up to 0.1 % and 0.5 GPa beyond; its "
      "factors are those with which a strip of {:g} mm, simulated with {} section points, drops as measured, "
      "from {:.1f} mm after {:g} s to {:.1f} mm at rest. E_static {:.3g} MPa, omega_1 {:.3g} 1/s, alpha {:.3g} 1/s",
      1e3 * strip.tips.length, tests.section_points, 1e3 * law.first_tip, law.times.back(), 1e3 * law.static_tip,
      1e-6 * 12 * law.stiffness / std::pow(tests.thickness, 3), law.frequency, law.alpha);
  return fields;
}

MaterialFields material_of(const Tests& tests, const Characterisation& found) {
  MaterialFields material = tests.assumed.value_or(MaterialFields());
  const auto need = [&](bool tested, const char* mode) {
    if (!tested && !tests.assumed)
      throw WrongInput(fmt::format("{} is not tested; `assumed` must give it", mode));
  };
  need(found.tension.has_value(), "tension");
  need(found.bias || found.frame, "shear");
  need(found.compression.has_value(), "bending, that is compression of fibres,");
  need(tests.transverse_shear_modulus.has_value(), "`transverse_shear_modulus` is not given, and");
  if (tests.assumed && tests.assumed->law != 0)
    throw WrongInput("assumed: expected curves (\"law\": \"tables\"), to which those of the tests belong");
  material.name = tests.name;
  material.source = tests.source;
  material.thickness = tests.thickness;
  material.areal_density = tests.areal_density;
  const auto assumed = [](CurveFields& fields) {
    if (!fields.source.starts_with("Assumed")) fields.source = "Assumed, not tested. " + fields.source;
  };
  if (found.tension)
    material.tension = tension_fields(*found.tension, tests);
  else
    assumed(material.tension);
  if (found.compression)
    material.compression = compression_fields(*found.compression, found.strips.front(), tests);
  else
    assumed(material.compression);
  if (tests.transverse_shear_modulus) material.transverse_shear_modulus = *tests.transverse_shear_modulus;
  if (found.bias) {
    const StripTest& first = tests.bias_extension.front();
    material.shear = shear_fields(
        *found.bias, fmt::format("Bias extension of {}, {:g} x {:g} mm, at {}",
                                 specimens(tests.bias_extension.size()), 1e3 * first.width,
                                 1e3 * first.height, speeds(tests.bias_extension)));
  } else if (found.frame) {
    material.shear = shear_fields(*found.frame, fmt::format("Picture frame, {}, at {}",
                                                            specimens(tests.picture_frame.size()),
                                                            speeds(tests.picture_frame)));
  } else {
    assumed(material.shear);
  }
  if (found.bias || found.frame) material.shear_measure = tests.shear_measure;
  return material;
}

/// What the strips of the bending model are made of: compression is sought, all else is known.
Fabric fabric_for_bending(const Tests& tests, const Characterisation& found) {
  if (!found.tension && !tests.assumed) throw WrongInput("cantilever: tension must be tested or assumed");
  if (!tests.transverse_shear_modulus && !tests.assumed)
    throw WrongInput("cantilever: `transverse_shear_modulus` must be given or assumed");
  Fabric fabric = tests.assumed ? fabric_of(*tests.assumed) : Fabric();
  fabric.thickness = tests.thickness;
  fabric.areal_density = tests.areal_density;
  if (found.tension) fabric.tension = found.tension->curve;
  if (tests.transverse_shear_modulus) fabric.transverse_shear_modulus = *tests.transverse_shear_modulus;
  if (found.bias)
    fabric.shear = found.bias->table.slowest();
  else if (found.frame)
    fabric.shear = found.frame->table.slowest();
  else if (!tests.assumed)
    throw WrongInput("cantilever: shear must be tested or assumed");
  return fabric;
}

/// (displacement, force) as measured, from the first row on.
std::vector<Eigen::Vector2d> force_over_way(const StripTest& test) {
  std::vector<Eigen::Vector2d> points;
  const std::vector<double>& way = test.table[TestQuantity::displacement];
  for (size_t k = 0; k < test.table.rows(); ++k)
    points.emplace_back(way[k] - way.front(), test.table[TestQuantity::force][k]);
  return points;
}

/// (displacement, force) of the strip alone: without the machine and the toe.
std::vector<Eigen::Vector2d> force_over_way(const StripTest& test, const StrainPoints& specimen, double thickness) {
  std::vector<Eigen::Vector2d> points;
  for (size_t k = 0; k < specimen.strain.size(); ++k)
    points.emplace_back(test.height * specimen.strain[k], test.width * thickness * specimen.stress[k]);
  return points;
}

/// Displacement at which a bias extension has sheared its fabric as far as the law's angles hold.
double way_to_valid(const StripTest& test, const ShearLaw& law) {
  const double half = std::numbers::pi / 4 - law.valid_to / 2;
  return (test.height - test.width) * (std::numbers::sqrt2 * std::cos(half) - 1);
}

/// Plays tests again with the material that was found: of tension the first specimen of the fastest rate, whose curve
/// the material has; of bias extension the first one of each rate; all cantilevers.
void verify(const Tests& tests, int threads, Characterisation& found) {
  const Fabric fabric = fabric_of(found.material);
  std::vector<std::function<Verification()>> runs;
  for (size_t k = 0; k < tests.tension.size(); ++k) {
    const StrainPoints& specimen = found.tension->specimens[k];
    if (specimen.rate != found.tension->rate) continue;
    runs.emplace_back([&, k] {
      const StripTest& test = tests.tension[k];
      return verify_strip(test, force_over_way(test, specimen, tests.thickness), fabric, false,
                          found.tension->valid_to * test.height);
    });
    break;
  }
  std::set<double> rates;
  for (const StripTest& test : tests.bias_extension) {
    if (!rates.insert(test.rate).second) continue;
    runs.emplace_back(
        [&] { return verify_strip(test, force_over_way(test), fabric, true, way_to_valid(test, *found.bias)); });
  }
  for (const StripHistory& strip : found.strips)
    runs.emplace_back([&] {
      return verify_cantilever(strip.tips, strip.file, fabric, tests.gravity, tests.section_points);
    });
  found.verifications.resize(runs.size());
  parallel_for(
      int(runs.size()), [&](int k) { found.verifications[size_t(k)] = runs[size_t(k)](); }, threads);
}

}  // namespace

Characterisation characterise(const Tests& tests, int threads,
                              const std::function<void(const std::string&)>& progress) {
  const auto say = [&](const std::string& what) {
    if (progress) progress(what);
  };
  Characterisation found;
  ShearOptions shear;
  shear.thickness = tests.thickness;
  shear.measure = ShearMeasure(tests.shear_measure);
  shear.by_law = tests.shear_rates == 0;
  if (tests.assumed) shear.rate_floor = tests.assumed->rate_floor;
  if (!tests.tension.empty()) {
    say("tension");
    found.tension = tension_law(tests.tension, tests.compliance, tests.thickness);
  }
  if (!tests.bias_extension.empty()) {
    say("bias extension");
    found.bias = bias_extension_law(tests.bias_extension, shear);
  }
  if (!tests.picture_frame.empty()) {
    say("picture frame");
    found.frame = picture_frame_law(tests.picture_frame, shear);
  }
  for (const CantileverTest& test : tests.cantilever) {
    if (test.profile.empty()) found.strips.push_back(history_of(test, tests));
  }
  if (!found.strips.empty()) {
    say("bending: fourteen strips");
    found.compression = compression_law(found.strips.front().tips, fabric_for_bending(tests, found),
                                        tests.gravity, tests.section_points, threads);
  }
  found.material = material_of(tests, found);
  for (const CantileverTest& test : tests.cantilever) {
    if (!test.profile.empty()) found.profiles.push_back(profile_law_of(test, tests, fabric_of(found.material)));
  }
  say("tests, simulated with the material");
  verify(tests, threads, found);
  return found;
}

nlohmann::json material_json(const MaterialFields& material) {
  MaterialFields fields = material;
  FieldWriter writer;
  visit_material(writer, fields);
  return writer.result();
}

}  // namespace drapeplan
