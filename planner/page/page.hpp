// The report of a run as one self-contained HTML page, and its scores as a table for the console.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/score/score.hpp"

namespace drapeplan {

/// One line of the table of scores. A part that is not known is NaN in `score` and shown as a dash.
struct ReportRow {
  std::string name;  ///< "wave"
  Score score;
  bool reference = false;  ///< published or measured elsewhere: shown, not compared
  bool beside = false;     ///< the score that the objective does not take: shown, not compared
};

/// A picture with its caption. `svg` is embedded as it is.
struct ReportFigure {
  std::string caption;
  std::string svg;
};

/// A table of texts; the first column stands to the left.
struct ReportTable {
  std::string title, caption;
  std::vector<std::string> head;
  struct Row {
    std::vector<std::string> cells;  ///< as many as in the head
    bool failed = false;             ///< stands out
    bool beside = false;             ///< grey
    std::string note = {};           ///< on a line of its own below
  };
  std::vector<Row> rows;
};

/// Why a drape is as it is, and what would change it.
struct ReportReasons {
  std::string text, remedy;
  ReportFigure figure;
  ReportTable folds;
};

/// All texts are plain text; they are escaped when written. What is empty is left out.
struct PlanReport {
  std::string title;                     ///< name of the case
  std::string description;               ///< what is draped, one or two sentences
  std::string verdict;                   ///< good enough or not, and what forbids it
  std::string outcome = {};              ///< what was found, and how it was confirmed
  std::optional<ReportReasons> reasons;  ///< beside a drape that is not accepted
  std::string view;                      ///< of the drape in space, from `view_markup`; embedded as it is
  std::string reach;                     ///< what the rig can reach at all, one or two sentences
  std::vector<ReportRow> rows;           ///< baselines first, the optimum last
  double ply_area = 0;                   ///< in the flat ply [m^2]; 0: not known
  std::vector<ReportTable> tables;
  std::vector<ReportFigure> figures;
  std::vector<std::string> notes;                          ///< assumptions and limits the reader must know
  std::vector<std::pair<std::string, std::string>> facts;  ///< name, value: evaluations, wall time, hash, ...
  std::vector<std::pair<std::string, std::string>> settings;  ///< path in the case file, value
  std::vector<std::pair<std::string, std::string>>
      files;  ///< name, what it holds; linked relative to the report
};

/// The page: no scripts but those of its view, nothing loaded from elsewhere. In each column of scores the
/// best valid row that is not a reference stands out.
std::string html_report(const PlanReport& report);

/// The parts of the scores that are compared, as a table for the console.
std::string console_table(const std::vector<ReportRow>& rows);

}  // namespace drapeplan
