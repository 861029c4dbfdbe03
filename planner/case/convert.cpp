// Between a case as its file states it and a case as the rest of the program uses it.
#include <cmath>

#include "planner/case/fields.hpp"

namespace drapeplan {
namespace {

Curve straight(double modulus) {
  return {{0, 1}, {0, modulus}};
}

bool is_straight(const StressTable& table) {
  if (table.curves.size() != 1) return false;
  const Curve& curve = table.slowest();
  return curve.strain == std::vector<double>{0, 1} && curve.stress.size() == 2;
}

/// A table as fields: every rate with its own points.
CurveFields curve_fields(const StressTable& table, const CurveNotes& notes) {
  CurveFields fields;
  static_cast<CurveNotes&>(fields) = notes;
  if (!table.curves.empty()) fields.curve = table.slowest();
  for (size_t k = 0; k < table.rates.size(); ++k)
    fields.rates.push_back({table.rates[k], 1, table.curves[k], {}});
  return fields;
}

bool has_notes(const CurveNotes& notes) {
  return !notes.source.empty() || notes.valid_to || notes.band;
}

/// Rate alpha of mass damping [1/s]. [Krogh], Eqs. (4) and (5), per width: the lowest frequency of a strip.
double alpha_of(const DampingFields& d, const std::optional<MaterialFields>& material) {
  if (d.by == 0 || !material) return d.alpha;
  const double modulus = d.modulus.value_or(material->modulus);
  const double stiffness = modulus * std::pow(material->thickness, 3) / 12;
  return 2 * d.ratio * strip_frequency(stiffness, material->areal_density, d.length);
}

/// Tables that are straight lines through strain 1 are stated as the linear law, so that moduli keep their
/// names.
MaterialFields material_fields(const Fabric& fabric, const MaterialNotes& notes) {
  MaterialFields m;
  m.name = notes.name;
  m.source = notes.source;
  m.thickness = fabric.thickness;
  m.areal_density = fabric.areal_density;
  m.transverse_shear_modulus = fabric.transverse_shear_modulus;
  const bool same = is_straight(fabric.tension) && is_straight(fabric.compression) &&
                    fabric.tension.slowest().stress == fabric.compression.slowest().stress &&
                    fabric.shear_measure == ShearMeasure::conjugate;
  const bool noted = has_notes(notes.tension) || has_notes(notes.compression) || has_notes(notes.shear);
  if (same && is_straight(fabric.shear) && !noted) {
    m.law = 1;
    m.modulus = fabric.tension.slowest().stress[1];
    m.shear_modulus = fabric.shear.slowest().stress[1];
  } else {
    m.tension = curve_fields(fabric.tension, notes.tension);
    m.compression = curve_fields(fabric.compression, notes.compression);
    m.shear = curve_fields(fabric.shear, notes.shear);
    m.shear_measure = int(fabric.shear_measure);
    m.rate_floor = fabric.rate_floor;
    m.rate_filter = fabric.rate_filter;
  }
  return m;
}

/// In the order of interlinks().
std::vector<double> given_lengths(const RigOptions& rig, const InterlinkLength& length) {
  if (length.same > 0) return std::vector<double>(interlinks(rig).size(), length.same);
  std::vector<double> lengths;
  for (const auto* rows : {&length.warp, &length.weft}) {
    for (const std::vector<double>& row : *rows) lengths.insert(lengths.end(), row.begin(), row.end());
  }
  return lengths;
}

}  // namespace

Curve scaled(const Curve& original, double factor) {
  Curve curve = original;
  for (double& stress : curve.stress) stress *= factor;
  return curve;
}

double strip_frequency(double stiffness, double areal_density, double length) {
  constexpr double kFirstRoot = 1.8751040687119611;  // of cos x cosh x = -1: clamped-free beam
  return kFirstRoot * kFirstRoot * std::sqrt(stiffness / (areal_density * std::pow(length, 4)));
}

void complete_ply(CaseFields& fields) {
  Ply& ply = fields.definition.ply;
  const Eigen::Vector2d size = bounding_box(ply.outline).sizes();
  ply.width = ply.outline.empty() ? fields.width.value_or(0) : size.x();
  ply.height = ply.outline.empty() ? fields.height.value_or(0) : size.y();
}

StressTable stress_table(const CurveFields& fields) {
  if (fields.rates.empty()) return scaled(fields.curve, fields.factor);
  StressTable table;
  for (const RateFields& rate : fields.rates) {
    table.rates.push_back(rate.rate);
    table.curves.push_back(
        scaled(rate.curve.strain.empty() ? fields.curve : rate.curve, rate.factor * fields.factor));
  }
  if (table.rates.size() == 1) table.rates.clear();
  return table;
}

Fabric fabric_of(const MaterialFields& m) {
  const bool linear = m.law == 1;
  Fabric fabric;
  fabric.thickness = m.thickness;
  fabric.areal_density = m.areal_density;
  fabric.transverse_shear_modulus = m.transverse_shear_modulus;
  fabric.tension = linear ? straight(m.modulus) : stress_table(m.tension);
  fabric.compression = linear ? straight(m.modulus) : stress_table(m.compression);
  fabric.shear = linear ? straight(m.shear_modulus) : stress_table(m.shear);
  fabric.shear_measure = ShearMeasure(m.shear_measure);
  fabric.rate_floor = m.rate_floor;
  fabric.rate_filter = m.rate_filter;
  return fabric;
}

void complete_case(CaseFields& fields) {
  Case& c = fields.definition;
  if (const auto& m = fields.material) {
    c.material = fabric_of(*m);
    c.material_notes = {m->name, m->source, m->tension, m->compression, m->shear};
  }
  if (c.grippers && c.grippers->interlinks) {
    InterlinkOptions& links = *c.grippers->interlinks;
    links.closing = c.schedule.preshape_duration * c.interlink_closing;
    if (c.interlink_length.source == InterlinkLength::Source::given)
      links.lengths = given_lengths(*c.grippers, c.interlink_length);
  }
  if (fields.damping) c.damping = alpha_of(*fields.damping, fields.material);
  if (fields.mold) {
    c.mold.emplace(mold_of(*fields.mold));
    c.mold_source = fields.mold->source;
  }
  c.chooses_fidelities = !fields.states_numerics && c.grippers && c.mold && fields.material;
  if (c.chooses_fidelities) c.fidelities = fidelities_from_sizes(c);
  c.fidelities.try_emplace("report", fields.fem);
}

CaseFields fields_of(const Case& definition) {
  CaseFields fields;
  fields.definition = definition;
  if (definition.ply.outline.empty()) {
    fields.width = definition.ply.width;
    fields.height = definition.ply.height;
  }
  if (definition.material.thickness > 0)
    fields.material = material_fields(definition.material, definition.material_notes);
  if (definition.mold) fields.mold = mold_fields(*definition.mold, definition.mold_source);
  if (definition.damping) fields.damping.emplace().alpha = *definition.damping;
  const auto report = fields.definition.fidelities.find("report");
  if (report != fields.definition.fidelities.end()) {
    fields.fem = report->second;
    fields.definition.fidelities.erase(report);  // it is `fem` itself
  }
  return fields;
}

}  // namespace drapeplan
