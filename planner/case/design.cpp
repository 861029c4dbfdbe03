#include "planner/case/design.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

/// Sections that say how a drape is computed or judged: to change them is no better rig.
bool is_judge(const std::string& path) {
  const std::string section = path.substr(0, path.find('.'));
  for (const char* judge : {"score", "fem", "fidelities", "optimise", "references", "format", "name"}) {
    if (section == judge) return true;
  }
  return false;
}

}  // namespace

std::optional<DesignRange> range_of(const DesignVariable& variable) {
  DesignRange range;
  const auto number = [](const std::string& text, double& value, std::string& unit) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    unit.assign(end, text.data() + text.size());
    return error == std::errc() && std::isfinite(value) && (unit.empty() || unit.front() == ' ');
  };
  std::string unit;
  if (!number(variable.from, range.from, range.unit) || !number(variable.to, range.to, unit)) return {};
  if (unit != range.unit) return {};
  return range;
}

std::string override_of(const DesignVariable& variable, double share) {
  const DesignRange range = range_of(variable).value();
  const double value = range.from + share * (range.to - range.from);
  return range.unit.empty() ? fmt::format("{}={:.6g}", variable.path, value)
                            : fmt::format("{}=\"{:.6g}{}\"", variable.path, value, range.unit);
}

void check_design(const std::vector<DesignVariable>& design, FieldReader& reader) {
  std::set<std::string> paths;
  for (size_t k = 0; k < design.size(); ++k) {
    const std::string pointer = fmt::format("/optimise/design/{}", k);
    if (!reader.good(pointer)) continue;
    std::string nearest;
    if (is_judge(design[k].path)) {
      reader.fail(pointer + "/path",
                  "says how a drape is computed or judged, and cannot be part of a design");
    } else if (explain_field(design[k].path, nearest).empty()) {
      reader.fail(pointer + "/path",
                  nearest.empty() ? "there is no such field"
                                  : fmt::format("there is no such field; did you mean \"{}\"?", nearest));
    } else if (!paths.insert(design[k].path).second) {
      reader.fail(pointer + "/path", "another variable changes the same field");
    }
    const std::optional<DesignRange> range = range_of(design[k]);
    if (!range) {
      reader.fail(pointer + "/to", "expected numbers with the unit of \"from\", e.g. \"0 mm\" and \"5 mm\"");
    } else if (!(range->from < range->to)) {
      reader.fail(pointer + "/to", "must be larger than \"from\"");
    }
  }
}

}  // namespace drapeplan
