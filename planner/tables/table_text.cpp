#include "planner/tables/table_text.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "planner/base/text.hpp"

namespace drapeplan {

std::optional<InputError> load_table_text(const std::filesystem::path& file, std::string& text) {
  FileText whole = read_file(file);
  const auto fault = [&](int line, std::string message) {
    return InputError{file.string(), line, "", std::move(message)};
  };
  if (!whole.fault.empty()) return fault(0, "cannot be read: " + whole.fault);
  text = std::move(whole.text);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return fault(1, "is UTF-16; please export it as plain text or UTF-8");
  const size_t nul = text.find('\0');
  if (nul != std::string::npos)
    return fault(1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(nul), '\n')),
                 "has a NUL byte: it is no text, or UTF-16; please export it as plain text or UTF-8");
  if (text.find_first_not_of(" \t\r\n\"") == std::string::npos) return fault(1, "is empty");
  return std::nullopt;
}

void split_table(std::string_view text, char separator, size_t most_cells,
                 const std::function<bool(TableLine&&)>& see) {
  for (int number = 1; !text.empty(); ++number) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    TableLine one{number, {}};
    bool quoted = false, blank = true;
    size_t begin = 0;
    for (size_t k = 0; k <= line.size() && one.cells.size() <= most_cells; ++k) {
      if (k < line.size() && line[k] == '"') quoted = !quoted;
      if (k < line.size() && (line[k] != separator || quoted)) continue;
      one.cells.push_back(trimmed_cell(line.substr(begin, k - begin)));
      blank = blank && one.cells.back().empty();
      begin = k + 1;
    }
    if ((!blank || one.cells.size() > most_cells) && !see(std::move(one))) return;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::string trimmed_cell(std::string_view cell) {
  constexpr std::string_view kBlanks = " \t\r\"";
  const size_t first = cell.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(cell.substr(first, cell.find_last_not_of(kBlanks) - first + 1));
}

std::optional<double> cell_number(std::string_view cell) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (fault != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

}  // namespace drapeplan
