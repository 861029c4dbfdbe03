// Every field of a case file, stated once: JSON name, meaning, unit, range, default. The reader, the echo of
// defaults, the schema, `explain` and the error messages are visitors of this one statement.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "planner/case.hpp"
#include "planner/quantity.hpp"

namespace drapeplan {

/// Allowed values of a number, in the inside unit.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_excluded = false;
  bool highest_excluded = false;
  bool odd = false;  ///< only odd whole numbers

  [[nodiscard]] bool holds(double value) const;  ///< false for NaN
};

/// One of a few words; `index` counts `words`.
struct Choice {
  std::vector<std::string> words;
  std::function<int()> get;
  std::function<void(int)> set;
};

/// Any of a few words, each at most once.
struct ChoiceList {
  std::vector<std::string> words;
  std::function<std::vector<int>()> get;
  std::function<void(const std::vector<int>&)> set;
};

/// Curve of stress over `abscissa`, written as rows; the first row names the units.
struct Table {
  Curve* curve = nullptr;
  Dimension abscissa = Dimension::strain;
};

using Target =
    std::variant<double*, std::optional<double>*, int*, unsigned*, bool*, std::string*, Eigen::Vector2d*,
                 Eigen::Vector3d*, std::optional<std::array<int, 2>>*, Extent*, Choice, ChoiceList, Table>;

struct Field {
  std::string name;
  Target target;
  std::string doc;
  Dimension dimension = Dimension::none;
  Range range = {};
  bool required = false;
  std::string default_words = {};       ///< where the default depends on other fields
  std::vector<std::string> needs = {};  ///< sections of the case without which the field makes no sense
};

struct Section {
  std::string name;
  std::string doc;
  bool required = false;
  std::vector<std::string> needs = {};
  bool always = false;  ///< absent means that the defaults hold, not that the physics is absent
};

/// A list of objects.
struct ObjectList {
  std::string name;
  std::string doc;
  bool required = false;
  std::vector<std::string> needs = {};
  size_t size = 0;
  std::function<void(size_t)> resize = {};
  std::function<void(size_t)> visit = {};
};

/// An object whose keys the user chooses, all with the same fields.
struct NamedObjects {
  std::string name;
  std::string doc;
  std::vector<std::string> needs = {};
  std::vector<std::string> names = {};
  std::function<void(const std::string&)> visit = {};  ///< makes the object if there is none of that name
};

class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void field(const Field& field) = 0;
  /// @return whether the section is there afterwards.
  virtual bool section(const Section& section, bool present, const std::function<void()>& visit) = 0;
  /// Fields that exist only if `selector` has the value `word`.
  virtual void alternative(const std::string& selector, const std::string& word, bool selected,
                           const std::function<void()>& visit) = 0;
  virtual void list(const ObjectList& list) = 0;
  virtual void named(const NamedObjects& objects) = 0;
};

/// The mold as the file states it.
struct MoldFields {
  int shape = 1;  ///< index of Mold::Shape
  Extent extent;
  double angle = 0;
  double unit = 1;
  std::vector<PolynomialShape::Term> terms;
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0;
  double azimuth = 0;
};

/// The curve at one rate, as the file states it.
struct RateFields {
  double rate = 0;
  double factor = 1;
  Curve curve;  ///< empty: the mode's own points
};

/// The stress curves of one mode as the file states them.
struct CurveFields {
  Curve curve;
  double factor = 1;
  std::string source;
  std::vector<RateFields> rates;  ///< empty: no dependence
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

/// Mass damping as the file states it: seed, Eqs. (4) and (5).
struct DampingFields {
  int by = 0;  ///< 0 alpha, 1 strip
  double alpha = 0;
  double ratio = 1, length = 0;
  std::optional<double> modulus;
};

/// A case as the file states it; sections that need work to become a Case stand beside it.
struct CaseFields {
  Case value;
  std::optional<MaterialFields> material;
  std::optional<MoldFields> mold;
  std::optional<DampingFields> damping;
  FemOptions fem;
};

inline constexpr const char* kCaseFormat = "drapeplan-case 1";

/// States all fields of a case to `visitor`, in the order of the documentation.
void visit_case(FieldVisitor& visitor, CaseFields& fields);

/// The table that a mode's fields state; @param fields  without errors.
StressTable stress_table(const CurveFields& fields);

/// Fields into a case and back. `complete` expects fields without errors.
void complete_case(CaseFields& fields);
CaseFields fields_of(const Case& value);

/// What a range allows, in the units of the dimension: "> 0 mm", "from 0 deg up to 90 deg (excluded)"; may be
/// empty.
std::string range_text(const Range& range, Dimension dimension);

}  // namespace drapeplan
