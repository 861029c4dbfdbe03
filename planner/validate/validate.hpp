// Comparisons with outside codes, closed forms and measurements: reference, ours, tolerance, verdict, source.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planner/page/page.hpp"

namespace drapeplan {

enum class Agreement {
  agrees,   ///< within the tolerance
  differs,  ///< not, or there is no figure of ours
  context,  ///< shown beside, not judged: nobody says how exact the reference is
};
const char* agreement_name(Agreement agreement);

/// One figure. Reference, ours and tolerance have the same unit.
struct ValidationRow {
  std::string what;  ///< a noun and where, "force at 20 mm"
  std::string unit;  ///< "mm"; empty for a number
  double reference = 0;
  double ours = 0;
  double tolerance = 0;  ///< absolute
  std::string source;    ///< of the reference
  std::string basis;     ///< what the tolerance is, "1 %"; empty: a figure that was stated
  std::string why = {};  ///< the mechanism, where a row is known to differ, or why it is not judged
  bool judged = true;

  [[nodiscard]] Agreement agreement() const;
};

/// @param share  of the reference that is tolerated.
ValidationRow within_share(std::string what, std::string unit, double reference, double ours, double share,
                           std::string source);

/// What one comparison found.
struct Findings {
  std::vector<ValidationRow> rows;
  std::vector<ReportFigure> figures = {};
};

/// A comparison that runs on its own, in seconds.
struct Comparison {
  std::string group, name;
  std::function<Findings()> compare;  ///< may throw: then there is one row that differs and says so
};

/// Lists of comparisons, one function per file.
void add_mapping_comparisons(std::vector<Comparison>& comparisons);
void add_shell_comparisons(std::vector<Comparison>& comparisons);
void add_twintex_comparisons(std::vector<Comparison>& comparisons);
void add_bending_comparisons(std::vector<Comparison>& comparisons);

/// All of them, by group.
std::vector<Comparison> comparisons();

struct ComparisonResult {
  std::string group, name;
  Findings findings;
  double seconds = 0;  ///< wall time
};

/// Runs one; never throws.
ComparisonResult run_comparison(const Comparison& comparison);

}  // namespace drapeplan
