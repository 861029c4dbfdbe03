#include "planner/views/files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/base/text.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/report/charts.hpp"
#include "planner/report/page_parts.hpp"
#include "planner/views/profile.hpp"
#include "planner/views/shear_view.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMillimetres = 1e3;
constexpr const char* kEnd = "end";

/// A cell of a table: quoted where its text needs it (RFC 4180).
std::string cell(const std::string& text) {
  return text.find_first_of(",\"\r\n") == std::string::npos ? text : quoted_cell(text);
}

/// A table that is filled column by column.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;

  template <class Value>
  void add(const std::string& name, size_t rows, const Value& value) {
    names.push_back(name);
    values.emplace_back();
    for (size_t k = 0; k < rows; ++k) values.back().push_back(value(k));
  }
  void add_vector(const std::string& name, const std::string& unit, double factor,
                  const std::vector<Vector3d>& vectors) {
    for (const Eigen::Index axis : {0, 1, 2})
      add(fmt::format("{} {} [{}]", name, "xyz"[axis], unit), vectors.size(),
          [&](size_t k) { return factor * vectors[k][axis]; });
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (size_t c = 0; c < names.size(); ++c) all += (c > 0 ? "," : "") + cell(names[c]);
    for (size_t row = 0; row < values.front().size(); ++row) {
      for (size_t c = 0; c < values.size(); ++c)
        all += fmt::format("{}{:.9g}", c > 0 ? "," : "\n", values[c][row] + 0.0);  // no "-0"
    }
    return all + "\n";
  }
};

Columns time_columns(const History& history) {
  Columns columns;
  const std::vector<double>& time = history.time;
  columns.add("time [s]", time.size(), [&](size_t k) { return time[k]; });
  if (history.time_scaling != 1)
    columns.add("simulated time [s]", time.size(), [&](size_t k) { return time[k] / history.time_scaling; });
  return columns;
}

std::vector<Vector3d> displacements(const ProbeTrack& probe) {
  std::vector<Vector3d> moved;
  for (const Vector3d& place : probe.place) moved.push_back(place - probe.start);
  return moved;
}

/// The way of all probes over time: downwards where there is gravity, else whichever way.
ReportFigure probes_figure(const History& history, bool gravity) {
  Chart chart{.title = gravity ? "Drop of the probes" : "Way of the probes",
              .x_label = "time [s]",
              .y_label = gravity ? "drop [mm]" : "displacement [mm]",
              .series = {}};
  for (const ProbeTrack& probe : history.probes) {
    ChartSeries series{.name = probe.name, .points = {}};
    const std::vector<Vector3d> moved = displacements(probe);
    for (size_t k = 0; k < moved.size(); ++k)
      series.points.emplace_back(history.time[k], kMillimetres * (gravity ? -moved[k].z() : moved[k].norm()));
    chart.series.push_back(series);
  }
  return {chart.title + " over the time of the case", line_chart(chart)};
}

/// Force over displacement of the grips that move, each along its own velocity; of grips at rest the force
/// over time.
ReportFigure grips_figure(const History& history) {
  const bool moves = std::any_of(history.grips.begin(), history.grips.end(),
                                 [](const GripTrack& grip) { return !grip.velocity.isZero(); });
  Chart chart{.title = "Force of the grips",
              .x_label = moves ? "displacement [mm]" : "time [s]",
              .y_label = "force [N]",
              .series = {}};
  for (const GripTrack& grip : history.grips) {
    if (moves && grip.velocity.isZero()) continue;
    ChartSeries series{.name = grip.name, .points = {}};
    const Vector3d way = grip.velocity.normalized();
    for (size_t k = 0; k < grip.force.size(); ++k) {
      if (moves)
        series.points.emplace_back(kMillimetres * grip.displacement[k].dot(way), grip.force[k].dot(way));
      else
        series.points.emplace_back(history.time[k], grip.force[k].norm());
    }
    chart.series.push_back(series);
  }
  return {moves ? "Force on the ply over the displacement of each grip, both along its velocity"
                : "Force of each grip on the ply over the time of the case",
          line_chart(chart)};
}

/// The ply at an instant along a line.
struct ProfileAtInstant {
  std::string name;
  double time = 0;
  std::vector<ProfilePoint> points;
};

std::string profile_csv(const std::vector<ProfileAtInstant>& profiles, bool mold) {
  std::string text =
      fmt::format("time [s],along [mm],x [mm],y [mm],ply [mm]{}\n", mold ? ",mold [mm],gap [mm]" : "");
  for (const ProfileAtInstant& profile : profiles) {
    for (const ProfilePoint& point : profile.points) {
      const Vector3d place = kMillimetres * point.place;
      text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", profile.time, kMillimetres * point.along,
                          place.x(), place.y(), place.z());
      if (mold) text += fmt::format(",{:.9g},{:.9g}", kMillimetres * point.mold, kMillimetres * point.gap);
      text += "\n";
    }
  }
  return text;
}

/// Heights of ply and mold at all instants.
ReportFigure heights_figure(const std::string& name, const std::vector<ProfileAtInstant>& profiles,
                            bool mold) {
  Chart chart{.title = fmt::format("Ply along \"{}\"", name),
              .x_label = "along the line [mm]",
              .y_label = "height [mm]",
              .series = {},
              .side_legend = true};
  for (const ProfileAtInstant& profile : profiles) {
    ChartSeries ply{.name = "ply, " + profile.name, .points = {}};
    for (const ProfilePoint& point : profile.points)
      ply.points.emplace_back(kMillimetres * point.along, kMillimetres * point.place.z());
    chart.series.push_back(ply);
  }
  if (mold) {
    ChartSeries below{.name = "mold", .points = {}};
    for (const ProfilePoint& point : profiles.back().points)
      below.points.emplace_back(kMillimetres * point.along, kMillimetres * point.mold);
    chart.series.push_back(below);
  }
  return {fmt::format("Heights along the line \"{}\"", name), line_chart(chart)};
}

/// The gap at the end.
ReportFigure gap_figure(const std::string& name, const ProfileAtInstant& end) {
  Chart chart{.title = fmt::format("Gap along \"{}\" at the end", name),
              .x_label = "along the line [mm]",
              .y_label = "gap [mm]",
              .series = {{.name = "", .points = {}}}};
  for (const ProfilePoint& point : end.points)
    chart.series.front().points.emplace_back(kMillimetres * point.along, kMillimetres * point.gap);
  return {fmt::format("Gap between ply and mold along the line \"{}\" at the end of the run", name),
          line_chart(chart)};
}

/// Writes files into the folder of a run and notes them for its page.
class Page {
 public:
  Page(std::filesystem::path folder, const Case& definition, const Model& model, const Recorder& seen,
       const RunResult& run, DrapePage drape)
      : folder_(std::move(folder)) {
    const RunSummary& summary = run.summary;
    const std::vector<double>& time = seen.history().time;
    page_.title = definition.name;
    page_.description = definition.description;
    page_.verdict = fmt::format("{}{}The run ended at {:.6g} s: {}.", drape.verdict,
                                drape.verdict.empty() ? "" : " ", run.final.time, summary.message);
    page_.reasons = std::move(drape.reasons);
    page_.rows = std::move(drape.rows);
    page_.ply_area = ply_area(model.scene().mesh);
    if (drape.frames != nullptr) {
      const std::vector<ViewDrape> viewed{{"this run", &model.scene(), drape.frames}};
      page_.view = space_view(viewed, drape.mapping);
      page_.tables.push_back(angles_table(viewed, drape.mapping));
    }
    page_.tables.insert(page_.tables.end(), drape.tables.begin(), drape.tables.end());
    page_.notes = std::move(drape.notes);
    const std::vector<std::string> sources = source_notes(definition);
    page_.notes.insert(page_.notes.end(), sources.begin(), sources.end());
    page_.figures = std::move(drape.figures);
    if (!drape.fidelity.empty()) page_.facts = {{"fidelity", drape.fidelity}};
    page_.facts.insert(
        page_.facts.end(),
        {{"shown", time.empty() ? "" : fmt::format("{:.6g} s to {:.6g} s", time.front(), time.back())},
         {"steps", fmt::format("{} of {:.3g} \u00b5s", summary.steps, 1e6 * summary.dt)},
         {"nodes", fmt::to_string(model.node_count())},
         {"wall time", fmt::format("{:.1f} s", summary.wall_seconds)},
         {"time scaling", fmt::format("{:g}", seen.history().time_scaling)},
         {"kinetic over internal energy, at most", fmt::format("{:.2g}", summary.largest_kinetic_ratio)},
         {"energy balance error", fmt::format("{:.1e} of the largest energy", summary.energy.balance_error)},
         {"state hash", hex(summary.state_hash)}});
    page_.files = std::move(drape.files);
    page_.files.insert(page_.files.end(), {{"result.json", "all results"},
                                           {"resolved.json", "the complete case with all defaults"}});
  }
  void table(const std::string& name, const std::string& text, const std::string& what) {
    write_text(folder_ / name, text);
    page_.files.emplace_back(name, what);
  }
  void figure(const std::string& name, ReportFigure figure) {
    write_text(folder_ / name, figure.svg);
    page_.figures.push_back(std::move(figure));
  }
  void write() const { write_text(folder_ / "report.html", html_report(page_)); }

 private:
  std::filesystem::path folder_;
  PlanReport page_;
};

void add_profile(Page& page, const Case& definition, const Profile& line, const Mesh& mesh,
                 const std::vector<NamedSnapshot>& instants) {
  const Mold* mold = definition.mold ? &*definition.mold : nullptr;
  std::vector<ProfileAtInstant> profiles;
  for (const NamedSnapshot& instant : instants)
    profiles.push_back({instant.name, instant.ply.time,
                        profile_of(line, mesh, instant.ply, mold, definition.material.thickness)});
  const std::string name = "profile_" + line.name;
  page.table(name + ".csv", profile_csv(profiles, mold != nullptr),
             fmt::format("the ply along \"{}\"", line.name));
  page.figure(name + "_heights.svg", heights_figure(line.name, profiles, mold != nullptr));
  if (mold != nullptr) page.figure(name + ".svg", gap_figure(line.name, profiles.back()));
}

}  // namespace

std::string probes_csv(const History& history) {
  Columns columns = time_columns(history);
  for (const ProbeTrack& probe : history.probes) {
    columns.add_vector(probe.name, "mm", kMillimetres, probe.place);
    const std::vector<Vector3d> moved = displacements(probe);
    columns.add_vector(probe.name + " displacement", "mm", kMillimetres, moved);
    columns.add(probe.name + " drop [mm]", moved.size(),
                [&](size_t k) { return -kMillimetres * moved[k].z(); });
    if (!probe.gap.empty())
      columns.add(probe.name + " gap [mm]", moved.size(),
                  [&](size_t k) { return kMillimetres * probe.gap[k]; });
  }
  return columns.text();
}

std::string grips_csv(const History& history) {
  Columns columns = time_columns(history);
  for (const GripTrack& grip : history.grips) {
    columns.add_vector(grip.name + " displacement", "mm", kMillimetres, grip.displacement);
    columns.add_vector(grip.name + " force", "N", 1, grip.force);
  }
  return columns.text();
}

void write_run(const std::filesystem::path& folder, const Case& definition, const Model& model,
               const Recorder& seen, const RunResult& run, DrapePage drape) {
  const History& history = seen.history();
  const Mesh& mesh = model.scene().mesh;
  std::vector<NamedSnapshot> instants = seen.instants();
  instants.push_back({kEnd, run.final});
  Page page(folder, definition, model, seen, run, std::move(drape));
  if (!history.probes.empty()) {
    page.figure("probes.svg", probes_figure(history, definition.gravity.has_value()));
    page.table("probes.csv", probes_csv(history), "ways of the probes over time");
  }
  if (!history.grips.empty()) {
    page.figure("grips.svg", grips_figure(history));
    page.table("grips.csv", grips_csv(history), "displacements and forces of the grips over time");
  }
  for (const Profile& line : definition.profiles) add_profile(page, definition, line, mesh, instants);
  std::vector<ShearPanel> panels;
  for (const NamedSnapshot& instant : instants) panels.push_back({instant.name, &instant.ply});
  page.figure("shear.svg", {"The ply in space; colour is the shear angle",
                            shear_picture(panels, mesh, definition.mold ? &*definition.mold : nullptr)});
  page.write();
}

}  // namespace drapeplan
