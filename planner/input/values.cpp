#include "planner/input/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/base/json_text.hpp"
#include "planner/base/spelling.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

std::string allowed_text(const Field& field) {
  const std::string range = range_text(field.range, field.dimension);
  return range.empty() ? "" : "; allowed: " + range;
}

/// One place of a JSON value while it is read.
struct ValueReader {
  const Field& field;
  const ValueFault& fault;
  std::string where;  ///< relative to the field's value

  bool fail(const std::string& message) const {
    fault(where, message);
    return false;
  }
  [[nodiscard]] ValueReader at(size_t index) const {
    return {field, fault, fmt::format("{}/{}", where, index)};
  }

  bool in_range(double value) const {
    return field.range.holds(value) || fail("out of range" + allowed_text(field));
  }

  bool number(const json& value, double& target) const {
    if (field.dimension == Dimension::none) {
      if (!value.is_number()) return fail("expected a bare number, e.g. 0.5" + allowed_text(field));
      target = value.get<double>();
      return in_range(target);
    }
    const DimensionWords& words = words_of(field.dimension);
    if (value.is_number()) {
      return fail(fmt::format("a bare number has no unit; expected {} as text, e.g. \"{}\"", words.name,
                              words.example));
    }
    if (!value.is_string())
      return fail(fmt::format("expected {} as text, e.g. \"{}\"", words.name, words.example));
    std::string message;
    const std::optional<double> parsed =
        parse_quantity(value.get_ref<const std::string&>(), field.dimension, message);
    if (!parsed) return fail(message);
    target = *parsed;
    return in_range(target);
  }

  template <class Integer>
  bool integer(const json& value, Integer& target) const {
    const double number = value.is_number() ? value.get<double>() : 0.5;
    const bool fits = number >= double(std::numeric_limits<Integer>::lowest()) &&
                      number <= double(std::numeric_limits<Integer>::max());
    if (!fits || std::floor(number) != number) {
      const std::string range = allowed_text(field);
      return fail("expected a whole number" + (range.empty() && !std::numeric_limits<Integer>::is_signed
                                                   ? "; allowed: >= 0 and <= 4294967295"
                                                   : range));
    }
    target = Integer(number);
    return in_range(number);
  }

  bool list(const json& value, size_t size, const std::string& what) const {
    return (value.is_array() && value.size() == size) || fail("expected " + what);
  }

  template <class Vector>
  bool vector(const json& value, Vector& target) const {
    const auto size = size_t(target.size());
    const std::vector<std::string> examples(size, fmt::format("\"{}\"", words_of(field.dimension).example));
    const std::string what =
        fmt::format("a list of {} quantities, e.g. [{}]", size, fmt::join(examples, ", "));
    if (!list(value, size, what)) return false;
    bool good = true;
    for (size_t k = 0; k < size; ++k) good = at(k).number(value[k], target[Eigen::Index(k)]) && good;
    return good;
  }

  bool extent(const json& value, Extent& target) const {
    const std::string what = "two pairs of lengths, e.g. [[\"0 mm\", \"450 mm\"], [\"0 mm\", \"450 mm\"]]";
    if (!list(value, 2, what)) return false;
    bool good = true;
    for (size_t k = 0; k < 2; ++k) {
      const ValueReader pair = at(k);
      double* const limits[2] = {&target.lower[Eigen::Index(k)], &target.upper[Eigen::Index(k)]};
      if (!pair.list(value[k], 2, "a pair of lengths, the lower one first")) {
        good = false;
        continue;
      }
      const bool lower = pair.at(0).number(value[k][0], *limits[0]);
      const bool upper = pair.at(1).number(value[k][1], *limits[1]);
      good = lower && upper && good;
      if (lower && upper && !(*limits[0] < *limits[1])) good = pair.fail("expected the lower length first");
    }
    return good;
  }

  bool word(const json& value, const std::vector<std::string>& words, int& index) const {
    const std::string expected = "expected " + alternatives_text(words);
    if (!value.is_string()) return fail(expected);
    const auto& text = value.get_ref<const std::string&>();
    const auto found = std::find(words.begin(), words.end(), text);
    index = int(found - words.begin());
    if (found != words.end()) return true;
    const std::string nearest = nearest_word(text, words);
    const std::string hint = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
    return fail(fmt::format("unknown word; {}{}", hint, expected));
  }

  bool words(const json& value, const ChoiceList& target) const {
    if (!value.is_array() || value.empty())
      return fail("expected a list of " + alternatives_text(target.words));
    std::vector<int> indices;
    bool good = true;
    for (size_t k = 0; k < value.size(); ++k) {
      int index = 0;
      if (!at(k).word(value[k], target.words, index)) {
        good = false;
      } else if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
        good = at(k).fail("appears twice");
      } else {
        indices.push_back(index);
      }
    }
    if (good) target.set(indices);
    return good;
  }

  bool points(const json& value, const PointList& target) const {
    if (!value.is_array() || value.size() < target.fewest) {
      const bool line = target.fewest == 2;
      return fail(fmt::format("expected a list of at least {} points, e.g. [[\"0 mm\", \"0 mm\"], [\"90 mm\", "
                              "\"0 mm\"]{}]",
                              line ? "two" : "three", line ? "" : ", [\"0 mm\", \"60 mm\"]"));
    }
    std::vector<Eigen::Vector2d> read(value.size());
    bool good = true;
    for (size_t k = 0; k < value.size(); ++k) good = at(k).vector(value[k], read[k]) && good;
    if (good) *target.points = std::move(read);
    return good;
  }

  /// Two lists of rows.
  bool rows(const json& value, const WordOrRows& target) const {
    bool good = true;
    for (size_t k = 0; k < 2; ++k) {
      const ValueReader list = at(k);
      if (!value[k].is_array()) {
        good = list.fail("expected a list of rows");
        continue;
      }
      std::vector<std::vector<double>> read(value[k].size());
      for (size_t row = 0; row < read.size(); ++row) {
        if (!value[k][row].is_array()) {
          good = list.at(row).fail("expected a row of quantities");
          continue;
        }
        read[row].resize(value[k][row].size());
        for (size_t n = 0; n < read[row].size(); ++n)
          good = list.at(row).at(n).number(value[k][row][n], read[row][n]) && good;
      }
      *target.rows[k] = std::move(read);
    }
    return good;
  }

  bool word_or_rows(const json& value, const WordOrRows& target) const {
    const DimensionWords& words = words_of(field.dimension);
    if (value.is_array() && value.size() == 2) {
      target.word.set(int(target.word.words.size()));
      return rows(value, target);
    }
    if (!value.is_string())
      return fail("expected " + alternatives_text(target.word.words) + ", " + words.name +
                  " as text, e.g. \"" + words.example + "\", or two lists of rows of them");
    const auto& text = value.get_ref<const std::string&>();
    if (!text.empty() && (std::isalpha(static_cast<unsigned char>(text.front())) != 0)) {
      int index = 0;
      if (!word(value, target.word.words, index)) return false;
      target.word.set(index);
      return true;
    }
    target.word.set(int(target.word.words.size()));
    return number(value, *target.same);
  }

  bool table(const json& value, const Table& target) const;
};

/// Number of a table cell in the unit of its column.
bool cell(const ValueReader& place, const json& value, const Unit& unit, double& target) {
  if (!value.is_number()) return place.fail("expected a bare number in the unit of its column");
  target = value.get<double>() * unit.multiply / unit.divide;
  return std::isfinite(target) || place.fail("the number is too large");
}

bool ValueReader::table(const json& value, const Table& target) const {
  const DimensionWords& x_words = words_of(target.abscissa);
  const std::string x_unit = x_words.units[x_words.preferred].name;
  const std::string example = fmt::format("[[\"{}\", \"MPa\"], [0, 0], [0.5, 45.6], ...]", x_unit);
  constexpr size_t kFewestRows = 3;  // units, origin, one point
  if (!value.is_array() || value.size() < kFewestRows)
    return fail("expected at least three rows, e.g. " + example);
  bool good = true;
  for (size_t row = 0; row < value.size(); ++row) {
    const std::string what = row == 0
                                 ? fmt::format("the units of the columns, e.g. [\"{}\", \"MPa\"]", x_unit)
                                 : "a pair of numbers [strain, stress]";
    good = at(row).list(value[row], 2, what) && good;
  }
  if (!good) return false;
  const Unit* units[2] = {nullptr, nullptr};
  const Dimension dimensions[2] = {target.abscissa, Dimension::stress};
  for (size_t k = 0; k < 2; ++k) {
    const json& name = value[0][k];
    if (name.is_string()) units[k] = find_unit(dimensions[k], name.get_ref<const std::string&>());
    if (units[k] == nullptr) {
      good = at(0).at(k).fail(
          unit_fault(name.is_string() ? name.get<std::string>() : value_text(name), dimensions[k]));
    }
  }
  if (!good) return false;
  Curve curve;
  for (size_t row = 1; row < value.size(); ++row) {
    double strain = 0, stress = 0;
    const bool x_good = cell(at(row).at(0), value[row][0], *units[0], strain);
    const bool y_good = cell(at(row).at(1), value[row][1], *units[1], stress);
    good = good && x_good && y_good;
    if (!x_good || !y_good) continue;
    if (row == 1 && (strain != 0 || stress != 0)) good = at(row).fail("a curve starts at [0, 0]");
    if (!curve.strain.empty() && !(strain > curve.strain.back())) {
      good = at(row).at(0).fail("strains must increase from row to row");
    }
    if (!curve.stress.empty() && !(stress >= curve.stress.back())) {
      good = at(row).at(1).fail("stresses must not decrease from row to row");
    }
    curve.strain.push_back(strain);
    curve.stress.push_back(stress);
  }
  if (good) *target.curve = std::move(curve);
  return good;
}

json quantity(double value, Dimension dimension) {
  if (dimension == Dimension::none) return value;
  return format_quantity(value, dimension);
}

/// Rows in the preferred units where that keeps every bit, otherwise in SI.
json table_rows(const Table& table) {
  if (table.curve->strain.empty()) return nullptr;
  const Dimension dimensions[2] = {table.abscissa, Dimension::stress};
  const std::vector<double>* columns[2] = {&table.curve->strain, &table.curve->stress};
  const size_t count = table.curve->strain.size();
  json rows = json::array({json::array()});
  rows.insert(rows.end(), count, json::array());
  for (size_t k = 0; k < 2; ++k) {
    const DimensionWords& words = words_of(dimensions[k]);
    std::vector<double> numbers;
    for (const double value : *columns[k]) {
      const std::string text = format_quantity(value, dimensions[k]);
      if (text.ends_with(' ' + words.units[words.preferred].name)) {
        numbers.push_back(json::parse(text.substr(0, text.find(' '))).get<double>());
      }
    }
    const bool exact = numbers.size() == count;
    rows[0].push_back(words.units[exact ? words.preferred : 0].name);
    for (size_t row = 0; row < count; ++row)
      rows[row + 1].push_back(exact ? numbers[row] : (*columns[k])[row]);
  }
  return rows;
}

}  // namespace

std::string value_text(const json& value) {
  constexpr size_t kLongest = 60;
  std::string text = dump_json(value);
  if (text.size() > kLongest) {
    text.resize(kLongest);
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0x80) != 0)
      text.pop_back();  // whole characters
    text += "...";
  }
  return text;
}

bool read_value(const json& value, const Field& field, const ValueFault& fault) {
  const ValueReader reader{field, fault, ""};
  const Overloaded read{
      [&](double* target) { return reader.number(value, *target); },
      [&](std::optional<double>* target) { return reader.number(value, target->emplace()); },
      [&](int* target) { return reader.integer(value, *target); },
      [&](unsigned* target) { return reader.integer(value, *target); },
      [&](bool* target) {
        if (!value.is_boolean()) return reader.fail("expected true or false");
        *target = value.get<bool>();
        return true;
      },
      [&](std::string* target) {
        if (!value.is_string()) return reader.fail("expected a text");
        *target = value.get<std::string>();
        return !(field.required && target->empty()) || reader.fail("must not be empty");
      },
      [&](Eigen::Vector2d* target) { return reader.vector(value, *target); },
      [&](Eigen::Vector3d* target) { return reader.vector(value, *target); },
      [&](std::optional<std::array<int, 2>>* target) {
        if (!reader.list(value, 2, "a pair of whole numbers, e.g. [3, 3]")) return false;
        auto& pair = target->emplace();
        const bool first = reader.at(0).integer(value[0], pair[0]);
        return reader.at(1).integer(value[1], pair[1]) && first;
      },
      [&](Extent* target) { return reader.extent(value, *target); },
      [&](const PointList& target) { return reader.points(value, target); },
      [&](const Choice& target) {
        int index = 0;
        if (!reader.word(value, target.words, index)) return false;
        target.set(index);
        return true;
      },
      [&](const ChoiceList& target) { return reader.words(value, target); },
      [&](const Table& target) { return reader.table(value, target); },
      [&](const WordOrRows& target) { return reader.word_or_rows(value, target); },
  };
  return std::visit(read, field.target);
}

json write_value(const Field& field) {
  const auto lengths = [&field](const auto& vector) {
    json list = json::array();
    for (const double value : vector) list.push_back(quantity(value, field.dimension));
    return list;
  };
  const Overloaded write{
      [&](double* target) { return quantity(*target, field.dimension); },
      [&](std::optional<double>* target) { return *target ? quantity(**target, field.dimension) : json(); },
      [](int* target) { return json(*target); },
      [](unsigned* target) { return json(*target); },
      [](bool* target) { return json(*target); },
      [](std::string* target) { return target->empty() ? json() : json(*target); },
      [&](Eigen::Vector2d* target) { return lengths(*target); },
      [&](Eigen::Vector3d* target) { return lengths(*target); },
      [](std::optional<std::array<int, 2>>* target) { return *target ? json(**target) : json(); },
      [&](Extent* target) {
        return json::array({lengths(Eigen::Vector2d(target->lower.x(), target->upper.x())),
                            lengths(Eigen::Vector2d(target->lower.y(), target->upper.y()))});
      },
      [&](const PointList& target) {
        json list = json::array();
        for (const Eigen::Vector2d& point : *target.points) list.push_back(lengths(point));
        return list.empty() ? json() : list;
      },
      [](const Choice& target) { return json(target.words[size_t(target.get())]); },
      [](const ChoiceList& target) {
        json list = json::array();
        for (const int index : target.get()) list.push_back(target.words[size_t(index)]);
        return list.empty() ? json() : list;
      },
      [](const Table& target) { return table_rows(target); },
      [&](const WordOrRows& target) {
        const auto index = size_t(target.word.get());
        if (index < target.word.words.size()) return json(target.word.words[index]);
        if (*target.same > 0) return json(quantity(*target.same, field.dimension));
        json both = json::array();
        for (const auto* rows : target.rows) {
          json list = json::array();
          for (const std::vector<double>& row : *rows) list.push_back(lengths(row));
          both.push_back(std::move(list));
        }
        return both;
      },
  };
  return std::visit(write, field.target);
}

}  // namespace drapeplan
