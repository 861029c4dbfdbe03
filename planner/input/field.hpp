// What one field of an input file is: its name, target, meaning, unit, range and default; and the interface
// of all that visits fields: reader, writer and schema.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fem/law/fabric.hpp"
#include "mapping/mold.hpp"
#include "planner/base/quantity.hpp"

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

/// A word, one number for all, or two lists of rows of numbers.
struct WordOrRows {
  Choice word;  ///< index words.size(): none of them
  double* same = nullptr;
  std::array<std::vector<std::vector<double>>*, 2> rows{};
};

/// Points in order: corners of a polygon, or a line.
struct PointList {
  std::vector<Eigen::Vector2d>* points = nullptr;
  size_t fewest = 3;
};

using Target = std::variant<double*, std::optional<double>*, int*, unsigned*, bool*, std::string*,
                            Eigen::Vector2d*, Eigen::Vector3d*, std::optional<std::array<int, 2>>*, Extent*,
                            PointList, Choice, ChoiceList, Table, WordOrRows>;

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
  bool flag = false;    ///< `true` may stand for its defaults, `false` for its absence; not stated: `present`
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

/// What a range allows, in the units of the dimension: "> 0 mm", "from 0 deg up to 90 deg (excluded)"; may be
/// empty.
std::string range_text(const Range& range, Dimension dimension);

}  // namespace drapeplan
