// Every field of a case file, stated once: JSON name, meaning, unit, range, default. The reader, the echo of
// defaults, the schema, `explain` and the error messages are visitors of this one statement.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/input/field.hpp"
#include "planner/molds/mold_fields.hpp"
#include "planner/tables/curve_file.hpp"

namespace drapeplan {

/// The curve at one rate, as the file states it.
struct RateFields {
  double rate = 0;
  double factor = 1;
  Curve curve;       ///< empty: the mode's own points
  std::string file;  ///< table that holds the points; empty: they are stated
};

/// The stress curves of one mode as the file states them.
struct CurveFields : CurveNotes {
  Curve curve;
  double factor = 1;
  std::vector<RateFields> rates;  ///< empty: no dependence
  std::string file;               ///< table that holds the points; empty: they are stated
  CurveColumns columns;           ///< of all tables of this mode
};

/// The material as the file states it.
struct MaterialFields {
  std::string name, source;
  int law = 0;  ///< 0 tables, 1 linear
  double thickness = 0, areal_density = 0, transverse_shear_modulus = 0;
  CurveFields tension, compression, shear;
  double modulus = 0, shear_modulus = 0;
  int shear_measure = 0;  ///< index of ShearMeasure
  double rate_floor = Fabric().rate_floor, rate_filter = Fabric().rate_filter;
};

/// Mass damping as the file states it: [Krogh], Eqs. (4) and (5).
struct DampingFields {
  int by = 0;  ///< 0 alpha, 1 strip
  double alpha = 0;
  double ratio = 1, length = 0;
  std::optional<double> modulus;
};

/// A case as the file states it; sections that need work to become a Case stand beside it.
struct CaseFields {
  Case definition;
  std::optional<MaterialFields> material;
  std::optional<MoldFields> mold;
  std::optional<double> width, height;  ///< of a rectangular ply
  std::optional<DampingFields> damping;
  FemOptions fem;
  bool states_numerics = true;  ///< has `fem` or `fidelities`
};

inline constexpr const char* kCaseFormat = "drapeplan-case 1";
/// The name of its schema: what `$schema` of a case says where the schema lies beside it.
inline constexpr const char* kSchemaFile = "drapeplan-case-1.schema.json";

/// States all fields of a case to `visitor`, in the order of the documentation.
void visit_case(FieldVisitor& visitor, CaseFields& fields);

/// Sets the ply's size from `width` and `height` or from its outline.
void complete_ply(CaseFields& fields);

/// The table that a mode's fields state; @param fields  without errors.
StressTable stress_table(const CurveFields& fields);

/// The fabric that a material's fields state; @param fields  without errors.
Fabric fabric_of(const MaterialFields& fields);

/// The curve with all stresses multiplied.
Curve scaled(const Curve& curve, double factor);

/// [Krogh], Eq. (5): lowest angular frequency of a clamped strip [1/s]. @param stiffness  D per width [N m].
double strip_frequency(double stiffness, double areal_density, double length);

/// `screen`, `search` and `report` of a drape whose file names no numerical settings, from the sizes of its
/// rig, its mold and its schedule. @param definition  complete, with grippers and mold.
std::map<std::string, FemOptions> fidelities_from_sizes(const Case& definition);

/// Fields into a case and back. `complete` expects fields without errors.
void complete_case(CaseFields& fields);
CaseFields fields_of(const Case& definition);

}  // namespace drapeplan
