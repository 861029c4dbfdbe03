// Between a case as its file states it and a case as the rest of the program uses it.
#include <cmath>

#include "planner/case_fields.hpp"

namespace drapeplan {
namespace {

Curve straight(double modulus) {
  return {{0, 1}, {0, modulus}};
}

bool is_straight(const Curve& curve) {
  return curve.strain == std::vector<double>{0, 1} && curve.stress.size() == 2;
}

Curve scaled(const CurveFields& fields) {
  Curve curve = fields.curve;
  for (double& stress : curve.stress) stress *= fields.factor;
  return curve;
}

Fabric fabric_of(const MaterialFields& m) {
  const bool linear = m.law == 1;
  Fabric fabric;
  fabric.thickness = m.thickness;
  fabric.areal_density = m.areal_density;
  fabric.transverse_shear_modulus = m.transverse_shear_modulus;
  fabric.tension = linear ? straight(m.modulus) : scaled(m.tension);
  fabric.compression = linear ? straight(m.modulus) : scaled(m.compression);
  fabric.shear = linear ? straight(m.shear_modulus) : scaled(m.shear);
  return fabric;
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
                    fabric.tension.stress == fabric.compression.stress;
  const bool no_sources = (notes.tension_source + notes.compression_source + notes.shear_source).empty();
  if (same && is_straight(fabric.shear) && no_sources) {
    m.law = 1;
    m.modulus = fabric.tension.stress[1];
    m.shear_modulus = fabric.shear.stress[1];
  } else {
    m.tension = {fabric.tension, 1, notes.tension_source};
    m.compression = {fabric.compression, 1, notes.compression_source};
    m.shear = {fabric.shear, 1, notes.shear_source};
  }
  return m;
}

Mold::Shape shape_of(const MoldFields& m) {
  switch (m.shape) {
    case 0:
      return PlaneShape{m.angle};
    case 2:
      return SphereShape{m.centre, m.radius};
    case 3:
      return CylinderShape{m.centre, m.azimuth, m.radius};
    default:
      break;
  }
  PolynomialShape shape{m.terms};
  for (PolynomialShape::Term& term : shape.terms) term.coefficient *= std::pow(m.unit, 1 - term.i - term.j);
  return shape;
}

MoldFields mold_fields(const Mold& mold) {
  MoldFields m;
  m.shape = int(mold.shape().index());
  m.extent = mold.extent();
  if (const auto* plane = std::get_if<PlaneShape>(&mold.shape())) m.angle = plane->angle;
  if (const auto* polynomial = std::get_if<PolynomialShape>(&mold.shape())) m.terms = polynomial->terms;
  if (const auto* sphere = std::get_if<SphereShape>(&mold.shape())) {
    m.centre = sphere->centre;
    m.radius = sphere->radius;
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&mold.shape())) {
    m.centre = cylinder->centre;
    m.azimuth = cylinder->azimuth;
    m.radius = cylinder->radius;
  }
  return m;
}

}  // namespace

void complete_ply(CaseFields& fields) {
  Ply& ply = fields.value.ply;
  const Eigen::Vector2d size = bounding_box(ply.outline).sizes();
  ply.width = ply.outline.empty() ? fields.width.value_or(0) : size.x();
  ply.height = ply.outline.empty() ? fields.height.value_or(0) : size.y();
}

void complete_case(CaseFields& fields) {
  Case& c = fields.value;
  if (const auto& m = fields.material) {
    c.material = fabric_of(*m);
    c.material_notes = {m->name, m->source, m->tension.source, m->compression.source, m->shear.source};
  }
  if (fields.mold) c.mold.emplace(shape_of(*fields.mold), fields.mold->extent);
  c.fidelities.try_emplace("report", fields.fem);
}

CaseFields fields_of(const Case& value) {
  CaseFields fields;
  fields.value = value;
  if (value.ply.outline.empty()) {
    fields.width = value.ply.width;
    fields.height = value.ply.height;
  }
  if (value.material.thickness > 0) fields.material = material_fields(value.material, value.material_notes);
  if (value.mold) fields.mold = mold_fields(*value.mold);
  const auto report = fields.value.fidelities.find("report");
  if (report != fields.value.fidelities.end()) {
    fields.fem = report->second;
    fields.value.fidelities.erase(report);  // it is `fem` itself
  }
  return fields;
}

}  // namespace drapeplan
