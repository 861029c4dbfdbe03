#include "planner/tables/test_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"
#include "planner/tables/table_text.hpp"

namespace drapeplan {
namespace {

/// What a quantity is called: in our files, and in lower case by the programs of common machines.
struct QuantityWords {
  TestQuantity quantity;
  const char* name;
  Dimension dimension;
  std::vector<std::string> headers;
};

const std::array<QuantityWords, 8>& all_quantities() {
  static const std::array<QuantityWords, 8> list{{
      {TestQuantity::time, "time", Dimension::time, {"time", "test time", "zeit", "prüfzeit", "t"}},
      {TestQuantity::displacement,
       "displacement",
       Dimension::length,
       {"displacement", "extension", "crosshead", "crosshead displacement", "crosshead position", "position",
        "standard travel", "stroke", "standardweg", "traversenweg", "weg"}},
      {TestQuantity::force,
       "force",
       Dimension::force,
       {"force", "load", "standard force", "kraft", "standardkraft", "f"}},
      {TestQuantity::angle,
       "angle",
       Dimension::angle,
       {"angle", "shear angle", "winkel", "scherwinkel", "gamma"}},
      {TestQuantity::deflection,
       "deflection",
       Dimension::length,
       {"deflection", "tip deflection", "tip", "durchbiegung"}},
      {TestQuantity::distance, "distance", Dimension::length, {"distance", "x", "abstand"}},
      {TestQuantity::strain,
       "strain",
       Dimension::strain,
       {"strain", "nominal strain", "engineering strain", "tensile strain", "compressive strain", "dehnung",
        "stauchung", "epsilon", "eps"}},
      {TestQuantity::stress,
       "stress",
       Dimension::stress,
       {"stress", "nominal stress", "engineering stress", "tensile stress", "compressive stress", "shear stress",
        "spannung", "zugspannung", "druckspannung", "schubspannung", "sigma", "tau"}},
  }};
  return list;
}

const QuantityWords& words_of(TestQuantity quantity) {
  return *std::find_if(all_quantities().begin(), all_quantities().end(),
                       [&](const QuantityWords& words) { return words.quantity == quantity; });
}

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A cell of the row of names: "Load (kN)" is "Load" and "kN".
struct Header {
  std::string name, unit;
};

Header header_of(const std::string& cell) {
  const size_t open = cell.find_last_of("([");
  const bool unit = open != std::string::npos && (cell.back() == ')' || cell.back() == ']');
  if (!unit) return {cell, {}};
  return {trimmed_cell(cell.substr(0, open)), trimmed_cell(cell.substr(open + 1, cell.size() - open - 2))};
}

/// As machines write units: "sec", "°".
std::string usual_unit(const std::string& unit) {
  const Header bracketed = header_of(unit);
  const std::string inner = bracketed.unit.empty() ? unit : bracketed.unit;
  if (lower(inner) == "sec") return "s";
  if (inner == "°" || lower(inner) == "degrees") return "deg";
  return inner;
}

class TableReader {
 public:
  TableReader(const std::filesystem::path& file, const std::vector<WantedColumn>& wanted, size_t fewest)
      : file_(file), wanted_(wanted), fewest_(fewest) {}

  TableReading read() {
    std::string text;
    if (load(text) && split_at_names(text) && find_units()) read_rows();
    return std::move(reading_);
  }

 private:
  struct Column {
    TestQuantity quantity;
    size_t index = 0;  ///< of the cells
    Header header;
    const Unit* unit = nullptr;
  };

  bool fail(int line, const std::string& column, std::string message) {
    reading_.errors.push_back({file_.string(), line, column, std::move(message)});
    return false;
  }

  bool load(std::string& text) {
    std::optional<InputError> fault = load_table_text(file_, text);
    if (fault) reading_.errors.push_back(std::move(*fault));
    return !fault;
  }

  /// Splits lines into cells by the first separator with which a row has the names that are sought: notes may hold
  /// separators that the table does not use.
  bool split_at_names(const std::string& text) {
    std::vector<InputError> errors;  // if there is none: of the first one, or of one that has a name twice
    for (const char separator : {';', '\t', ','}) {
      if (separator != ',' && text.find(separator) == std::string::npos) continue;
      decimal_comma_ = separator != ',';
      reading_.errors.clear();
      if (split(text, separator) && find_names()) return true;
      if (errors.empty() || !reading_.errors.front().path.empty()) errors = reading_.errors;
    }
    reading_.errors = std::move(errors);
    return false;
  }

  bool split(const std::string& text, char separator) {
    constexpr size_t kMostCells = 1000;  // no test has so many channels
    lines_.clear();
    split_table(text, separator, kMostCells, [this](TableLine&& line) {
      lines_.push_back(std::move(line));
      return lines_.back().cells.size() <= kMostCells;
    });
    if (lines_.empty()) return fail(1, "", "is empty");
    return lines_.back().cells.size() <= kMostCells ||
           fail(lines_.back().number, "",
                fmt::format("has more than {} columns: it is no table of a test", kMostCells));
  }

  [[nodiscard]] bool is_called(const WantedColumn& wanted, const std::string& cell) const {
    constexpr size_t kLongestName = 200;
    if (cell.size() > kLongestName) return false;
    const std::string name = lower(header_of(cell).name);
    if (!wanted.header.empty()) return name == lower(wanted.header) || lower(cell) == lower(wanted.header);
    const auto& headers = words_of(wanted.quantity).headers;
    return std::find(headers.begin(), headers.end(), name) != headers.end();
  }

  /// The row of names is the first one that has all required columns.
  bool find_names() {
    for (names_ = 0; names_ < lines_.size(); ++names_) {
      columns_.clear();
      bool all = true;
      for (const WantedColumn& wanted : wanted_) {
        std::vector<Column> found;
        const TableLine& line = lines_[names_];
        for (size_t k = 0; k < line.cells.size(); ++k) {
          if (is_called(wanted, line.cells[k]))
            found.push_back({wanted.quantity, k, header_of(line.cells[k]), nullptr});
        }
        if (found.size() > 1)
          return fail(line.number, shown(found[1].header.name),
                      fmt::format("is the second column for the {}; say in `columns` which one is meant",
                                  quantity_name(wanted.quantity)));
        all = all && (found.size() == 1 || !wanted.required);
        columns_.insert(columns_.end(), found.begin(), found.end());
      }
      if (all && !columns_.empty()) return true;
    }
    std::vector<std::string> names;
    for (const WantedColumn& wanted : wanted_) {
      if (!wanted.required) continue;
      names.push_back(wanted.header.empty() ? fmt::format("the {} ({})", quantity_name(wanted.quantity),
                                                          fmt::join(words_of(wanted.quantity).headers, ", "))
                                            : fmt::format("\"{}\"", wanted.header));
    }
    return fail(lines_.front().number, "",
                fmt::format("no row names columns for {}; `columns` may say what they are called",
                            fmt::join(names, " and ")));
  }

  bool find_units() {
    first_row_ = names_ + 1;
    const bool beside =
        std::all_of(columns_.begin(), columns_.end(), [](const Column& c) { return !c.header.unit.empty(); });
    if (!beside && first_row_ < lines_.size()) {
      const TableLine& below = lines_[first_row_];
      for (Column& column : columns_) {
        const std::string cell = column.index < below.cells.size() ? below.cells[column.index] : "";
        const bool number = !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell.back())) != 0);
        if (column.header.unit.empty() && !number) column.header.unit = cell;
        if (!number) first_row_ = names_ + 2;
      }
    }
    for (Column& column : columns_) {
      const Dimension dimension = words_of(column.quantity).dimension;
      const std::string unit = usual_unit(column.header.unit);
      if (unit.empty())
        return fail(lines_[names_].number, column.header.name,
                    fmt::format("has no unit; expected one in brackets behind the name or below it, e.g. "
                                "\"{} [{}]\"",
                                column.header.name, drapeplan::words_of(dimension).units.front().name));
      column.unit = find_unit(dimension, unit);
      if (column.unit == nullptr)
        return fail(lines_[names_].number, column.header.name, unit_fault(shown(unit), dimension));
    }
    return true;
  }

  /// A number with a decimal point, or a decimal comma where commas do not separate.
  [[nodiscard]] std::optional<double> number(std::string cell) const {
    if (decimal_comma_ && cell.find('.') == std::string::npos) {
      const size_t comma = cell.find(',');
      if (comma != std::string::npos) cell[comma] = '.';
    }
    return cell_number(cell);
  }

  /// A file has one decimal sign. With a second one numbers of three digits behind it cannot be told from thousands.
  bool has_one_sign(const TableLine& line, const Column& column, const std::string& cell) {
    if (!decimal_comma_) return true;
    for (const char sign : {'.', ','}) {
      if (cell.find(sign) == std::string::npos) continue;
      if (sign_ == 0) sign_ = sign, sign_line_ = line.number;
      if (sign_ != sign)
        return fail(line.number, column.header.name,
                    fmt::format("\"{}\" has a decimal {}, but line {} a decimal {}: is one of them for thousands?",
                                shown(cell), sign == ',' ? "comma" : "point", sign_line_,
                                sign == ',' ? "point" : "comma"));
    }
    return true;
  }

  /// Cells that no column belongs to are decimal commas that separate.
  bool has_columns(const TableLine& line) {
    const auto used = [](const std::vector<std::string>& cells) {
      size_t count = cells.size();
      while (count > 0 && cells[count - 1].empty()) --count;
      return count;
    };
    const size_t cells = used(line.cells), names = used(lines_[names_].cells);
    return cells <= names ||
           fail(line.number, "",
                fmt::format("has {} cells, but line {} names {} columns; where commas separate columns, decimal signs "
                            "are points",
                            cells, lines_[names_].number, names));
  }

  bool read_cell(const TableLine& line, const Column& column) {
    const std::string cell = column.index < line.cells.size() ? line.cells[column.index] : "";
    const std::optional<double> value = number(cell);
    if (!value)
      return fail(line.number, column.header.name,
                  cell.empty() ? "has no number in this row" : fmt::format("\"{}\" is no number", shown(cell)));
    const double in_si = *value * column.unit->multiply / column.unit->divide;
    if (!std::isfinite(in_si))
      return fail(line.number, column.header.name, fmt::format("\"{}\" is no finite number", shown(cell)));
    if (!has_one_sign(line, column, cell)) return false;
    reading_.table.columns[column.quantity].push_back(in_si);
    return true;
  }

  void read_rows() {
    TestTable& table = reading_.table;
    for (const Column& column : columns_) table.columns[column.quantity];
    for (size_t k = first_row_; k < lines_.size(); ++k) {
      const TableLine& line = lines_[k];
      for (const Column& column : columns_) {
        if (!read_cell(line, column)) return;
      }
      if (!has_columns(line)) return;
      table.lines.push_back(line.number);
    }
    if (table.rows() < fewest_)
      fail(lines_[names_].number, "",
           fmt::format("has {} rows of numbers; it needs {} at least", table.rows(), fewest_));
  }

  const std::filesystem::path& file_;
  const std::vector<WantedColumn>& wanted_;
  size_t fewest_;
  std::vector<TableLine> lines_;
  bool decimal_comma_ = false;
  char sign_ = 0;       ///< the decimal sign of the first number that has one
  int sign_line_ = 0;
  size_t names_ = 0, first_row_ = 0;
  std::vector<Column> columns_;
  TableReading reading_;
};

}  // namespace

TableReading read_test_table(const std::filesystem::path& file, const std::vector<WantedColumn>& wanted,
                             size_t fewest) {
  return TableReader(file, wanted, fewest).read();
}

std::string quantity_name(TestQuantity quantity) {
  return words_of(quantity).name;
}

}  // namespace drapeplan
