#include "planner/validate/validate.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <limits>

namespace drapeplan {

const char* agreement_name(Agreement agreement) {
  constexpr const char* kNames[] = {"agrees", "differs", "context"};
  return kNames[size_t(agreement)];
}

Agreement ValidationRow::agreement() const {
  if (!judged) return Agreement::context;
  return std::abs(ours - reference) <= tolerance ? Agreement::agrees : Agreement::differs;
}

ValidationRow within_share(std::string what, std::string unit, double reference, double ours, double share,
                           std::string source) {
  return {std::move(what),
          std::move(unit),
          reference,
          ours,
          share * std::abs(reference),
          std::move(source),
          fmt::format("{:g} %", 100 * share)};
}

std::vector<Comparison> comparisons() {
  std::vector<Comparison> all;
  add_mapping_comparisons(all);
  add_shell_comparisons(all);
  add_twintex_comparisons(all);
  add_bending_comparisons(all);
  return all;
}

ComparisonResult run_comparison(const Comparison& comparison) {
  const auto start = std::chrono::steady_clock::now();
  ComparisonResult result{comparison.group, comparison.name, {}};
  try {
    result.findings = comparison.compare();
  } catch (const std::exception& error) {
    ValidationRow row{.what = comparison.name, .unit = "", .source = "", .basis = ""};
    row.reference = row.ours = std::numeric_limits<double>::quiet_NaN();
    row.why = fmt::format("it did not come to an end: {}", error.what());
    result.findings.rows.push_back(std::move(row));
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace drapeplan
