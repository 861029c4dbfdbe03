#include "planner/tables/test_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

/// What a quantity is called: in our files, and in lower case by the programs of common machines.
struct QuantityWords {
  TestQuantity quantity;
  const char* name;
  Dimension dimension;
  std::vector<std::string> headers;
};

const std::array<QuantityWords, 7>& all_quantities() {
  static const std::array<QuantityWords, 7> list{{
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

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\"";
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
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
  return {trimmed(cell.substr(0, open)), trimmed(cell.substr(open + 1, cell.size() - open - 2))};
}

/// As machines write units: "sec", "°".
std::string usual_unit(const std::string& unit) {
  const Header bracketed = header_of(unit);
  const std::string inner = bracketed.unit.empty() ? unit : bracketed.unit;
  if (lower(inner) == "sec") return "s";
  if (inner == "°" || lower(inner) == "degrees") return "deg";
  return inner;
}

struct Line {
  int number = 0;
  std::vector<std::string> cells;
};

class TableReader {
 public:
  TableReader(const std::filesystem::path& file, const std::vector<WantedColumn>& wanted, size_t fewest)
      : file_(file), wanted_(wanted), fewest_(fewest) {}

  TableReading read() {
    if (load() && find_names() && find_units()) read_rows();
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

  bool load() {
    std::error_code error;
    if (std::filesystem::is_directory(file_, error)) return fail(0, "", "is a folder, not a file");
    errno = 0;
    std::ifstream in(file_, std::ios::binary);
    if (!in) return fail(0, "", "cannot be read: " + std::generic_category().message(errno));
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
      return fail(1, "", "is UTF-16; please export it as plain text or UTF-8");
    if (utf8_prefix(text) < text.size() && text.find('\0') != std::string::npos)
      return fail(1, "", "is no text");
    split(text);
    if (lines_.empty()) return fail(0, "", "is empty");
    return true;
  }

  void split(const std::string& text) {
    const char separator = text.find(';') != std::string::npos    ? ';'
                           : text.find('\t') != std::string::npos ? '\t'
                                                                  : ',';
    decimal_comma_ = separator != ',';
    std::istringstream stream(text);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (trimmed(line).empty()) continue;
      Line one{number, {}};
      std::string cell;
      bool quoted = false;
      for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == separator && !quoted) {
          one.cells.push_back(trimmed(cell));
          cell.clear();
        } else {
          cell += c;
        }
      }
      one.cells.push_back(trimmed(cell));
      const bool blank =
          std::all_of(one.cells.begin(), one.cells.end(), [](const std::string& c) { return c.empty(); });
      if (!blank) lines_.push_back(std::move(one));
    }
  }

  [[nodiscard]] bool is_called(const WantedColumn& wanted, const std::string& cell) const {
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
        const Line& line = lines_[names_];
        for (size_t k = 0; k < line.cells.size(); ++k) {
          if (is_called(wanted, line.cells[k]))
            found.push_back({wanted.quantity, k, header_of(line.cells[k]), nullptr});
        }
        if (found.size() > 1)
          return fail(line.number, found[1].header.name,
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
      const Line& below = lines_[first_row_];
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
        return fail(lines_[names_].number, column.header.name, unit_fault(unit, dimension));
    }
    return true;
  }

  /// A number with a decimal point, or a decimal comma where commas do not separate.
  [[nodiscard]] std::optional<double> number(std::string cell) const {
    if (decimal_comma_ && cell.find('.') == std::string::npos) {
      const size_t comma = cell.find(',');
      if (comma != std::string::npos) cell[comma] = '.';
    }
    if (!cell.empty() && cell.front() == '+') cell.erase(0, 1);
    double value = 0;
    const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (fault != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      return std::nullopt;
    return value;
  }

  void read_rows() {
    TestTable& table = reading_.table;
    for (const Column& column : columns_) table.columns[column.quantity];
    for (size_t k = first_row_; k < lines_.size(); ++k) {
      const Line& line = lines_[k];
      for (const Column& column : columns_) {
        const std::string cell = column.index < line.cells.size() ? line.cells[column.index] : "";
        const std::optional<double> value = number(cell);
        if (!value) {
          fail(line.number, column.header.name,
               cell.empty() ? "has no number in this row" : fmt::format("\"{}\" is no number", cell));
          return;
        }
        table.columns[column.quantity].push_back(*value * column.unit->multiply / column.unit->divide);
      }
      table.lines.push_back(line.number);
    }
    if (table.rows() < fewest_)
      fail(lines_[names_].number, "",
           fmt::format("has {} rows of numbers; it needs {} at least", table.rows(), fewest_));
  }

  const std::filesystem::path& file_;
  const std::vector<WantedColumn>& wanted_;
  size_t fewest_;
  std::vector<Line> lines_;
  bool decimal_comma_ = false;
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
