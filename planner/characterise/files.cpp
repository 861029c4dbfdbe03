#include "planner/characterise/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"
#include "planner/page/page.hpp"
#include "planner/report/charts.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr double kToDegrees = 180 / std::numbers::pi;
constexpr size_t kShown = 400;  // points of a specimen in a chart

/// Points of a line, in the units of a chart; some of them if there are many.
std::vector<Eigen::Vector2d> points(const std::vector<double>& x, double x_unit, const std::vector<double>& y,
                                    double y_unit, double up_to = 1e300) {
  std::vector<Eigen::Vector2d> list;
  const size_t step = std::max<size_t>(1, x.size() / kShown);
  for (size_t k = 0; k < x.size(); k += step) {
    if (x[k] <= up_to) list.emplace_back(x_unit * x[k], y_unit * y[k]);
  }
  return list;
}

json curve_json(const Curve& curve) {
  return {{"strain", curve.strain}, {"stress", curve.stress}};
}

json shear_json(const ShearLaw& law) {
  json result{{"measured_to_deg", kToDegrees * law.measured_to},
              {"valid_to_deg", kToDegrees * law.valid_to},
              {"band", law.band},
              {"rates", law.table.rates},
              {"curves", json::array()},
              {"measured_curves", json::array()}};
  for (const Curve& curve : law.table.curves) result["curves"].push_back(curve_json(curve));
  for (const Curve& curve : law.measured) result["measured_curves"].push_back(curve_json(curve));
  return result;
}

ReportFigure tension_figure(const TensionLaw& law) {
  Chart chart{.title = "Tension", .x_label = "strain [%]", .y_label = "nominal stress [MPa]", .series = {},
              .side_legend = true};
  for (const StrainPoints& one : law.specimens)
    chart.series.push_back({.name = one.file,
                            .points = points(one.strain, 1e2, one.stress, 1e-6),
                            .dots = true});
  chart.series.push_back(
      {.name = "material", .points = points(law.curve.strain, 1e2, law.curve.stress, 1e-6), .marks = true});
  return {"Stress along the fibres over their strain, without what the machine moved and without the toe. The "
          "material takes the curve of the fastest rate.",
          line_chart(chart)};
}

std::string rate_text(double rate) {
  return fmt::format("{:.3g} 1/s", rate);
}

ReportFigure force_figure(const ShearLaw& law, const std::string& what) {
  Chart chart{.title = what + ": force", .x_label = "shear angle [deg]", .y_label = "force [N]", .series = {},
              .side_legend = true};
  for (const ShearForce& one : law.specimens)
    chart.series.push_back(
        {.name = one.name, .points = points(one.angle, kToDegrees, one.force, 1), .dots = true});
  for (const ShearForce& one : law.slices)
    chart.series.push_back(
        {.name = "at " + rate_text(one.rate), .points = points(one.angle, kToDegrees, one.force, 1)});
  return {"Forces of all specimens over the shear angle, and of the surface through them at constant rates.",
          line_chart(chart)};
}

ReportFigure stress_figure(const ShearLaw& law, const std::string& what, const char* measure) {
  Chart chart{.title = what + ": stress", .x_label = "shear angle [deg]",
              .y_label = fmt::format("shear stress, {} [kPa]", measure), .series = {}, .side_legend = true};
  for (size_t k = 0; k < law.table.curves.size(); ++k) {
    const std::string rate = law.table.rates.empty() ? "" : fmt::format(", {:.2g}/s", law.table.rates[k]);
    chart.series.push_back({.name = "measured" + rate,
                            .points = points(law.measured[k].strain, kToDegrees, law.measured[k].stress, 1e-3),
                            .dots = true});
    const Curve& curve = law.table.curves[k];
    chart.series.push_back({.name = "material" + rate,
                            .points = points(curve.strain, kToDegrees, curve.stress, 1e-3),
                            .marks = true});
  }
  return {"Shear stress over the angle. Where a measured curve falls, which would be unstable, the material has "
          "the nearest one that does not.",
          line_chart(chart)};
}

ReportFigure bending_figure(const CompressionLaw& law) {
  Chart chart{.title = "Bending model", .x_label = "factor of the compression curve", .y_label = "drop at rest [mm]",
              .series = {}, .log_x = true};
  chart.series.push_back(
      {.name = "simulated strips", .points = points(law.model.scale, 1, law.model.tip, 1e3), .marks = true});
  ChartSeries chosen{.name = "factors of the material", .points = {}, .dots = true, .rings = true};
  chosen.points.emplace_back(law.factors.front(), 1e3 * law.static_tip);
  chosen.points.emplace_back(law.factors.back(), 1e3 * law.first_tip);
  chart.series.push_back(chosen);
  return {fmt::format("Drops of simulated strips over the factor of their compression curve. The strip that was "
                      "tested drops by {:.1f} mm after 0.4 s and by {:.1f} mm at rest; the material has six factors "
                      "from the one to the other.",
                      1e3 * law.first_tip, 1e3 * law.static_tip),
          line_chart(chart)};
}

std::string shear_modulus_text(const StripHistory& strip) {
  return fmt::format("the slopes at the clamp mean a transverse shear modulus of {:.2g} MPa at first and {:.2g} MPa "
                     "in the end (Eq. (14))",
                     1e-6 * strip.shear_modulus.front(), 1e-6 * strip.shear_modulus.back());
}

ReportFigure strip_figure(const StripHistory& strip) {
  Chart chart{.title = fmt::format("Cantilever of {:g} mm", 1e3 * strip.tips.length), .x_label = "time [s]",
              .y_label = "drop of the tip [mm]", .series = {}, .log_x = true};
  chart.series.push_back({.name = "", .points = points(strip.tips.time, 1, strip.tips.tip, 1e3), .dots = true});
  std::string text = "Drop of the tip as measured";
  text += strip.shear_modulus.empty() ? "." : "; " + shear_modulus_text(strip) + ".";
  return {text, line_chart(chart)};
}

/// What a profile says, in words: the secant stiffness per width at the clamp, and how the material agrees.
std::string profile_text(const ProfileLaw& profile) {
  std::string text = fmt::format(
      "the strip's shape means a bending stiffness per width of {:.3g} N mm at the clamp, at a curvature of {:.3g} 1/m",
      1e3 * profile.law.strain.back() / profile.law.stress.back(), profile.law.stress.back());
  if (!profile.material.strain.empty())
    text += fmt::format("; with the material at rest it drops by {:.1f} mm, measured are {:.1f} mm",
                        1e3 * profile.material_drop, 1e3 * profile.drop);
  return text;
}

ReportFigure profile_figure(const ProfileLaw& profile) {
  Chart chart{.title = fmt::format("Moment of a strip of {:g} mm at rest", 1e3 * profile.length),
              .x_label = "curvature [1/m]", .y_label = "moment per width [N]", .series = {}};
  chart.series.push_back(
      {.name = "from the profile", .points = points(profile.law.stress, 1, profile.law.strain, 1), .marks = true});
  chart.series.push_back(
      {.name = "material at rest", .points = points(profile.material.stress, 1, profile.material.strain, 1)});
  return {fmt::format("{}: {}.", profile.file, profile_text(profile)), line_chart(chart)};
}

/// What a verification says, in words.
std::string verdict(const Verification& v) {
  if (!v.failure.empty()) return "did not come to its end: " + v.failure;
  if (v.what == Compared::force)
    return fmt::format("differs by {:.1f} % of the force at most, up to {:.1f} mm", 1e2 * v.error,
                       1e3 * v.compared_to);
  return fmt::format("differs by {:.1f} % of the drop at rest at most, from {:.3g} s on, and by {:.1f} % in the end",
                     1e2 * v.error, v.compared_from, 1e2 * v.end_error);
}

ReportFigure verification_figure(const Verification& v) {
  const bool force = v.what == Compared::force;
  Chart chart{.title = v.name,
              .x_label = force ? "displacement [mm]" : "time [s]",
              .y_label = force ? "force [N]" : "drop of the tip [mm]",
              .series = {},
              .log_x = !force};
  const Eigen::Array2d unit = force ? Eigen::Array2d(1e3, 1) : Eigen::Array2d(1, 1e3);
  ChartSeries measured{.name = "measured", .points = {}, .dots = true}, simulated{.name = "simulated", .points = {}};
  const size_t step = std::max<size_t>(1, v.measured.size() / kShown);
  for (size_t k = 0; k < v.measured.size(); k += step) measured.points.emplace_back(unit * v.measured[k].array());
  for (const Eigen::Vector2d& point : v.simulated) simulated.points.emplace_back(unit * point.array());
  chart.series = {measured, simulated};
  return {fmt::format("{}: {} and the same strip simulated with the material, which {}.", v.name, v.file, verdict(v)),
          line_chart(chart)};
}

json strip_json(const StripHistory& strip) {
  json result{{"file", strip.file},
              {"length", strip.tips.length},
              {"time", strip.tips.time},
              {"tip", strip.tips.tip}};
  if (strip.shapes.empty()) return result;
  result["root_strain"] = strip.root_strain;
  result["root_slope"] = json::array();
  for (const StripShape& shape : strip.shapes) result["root_slope"].push_back(shape.slope(0));
  result["transverse_shear_modulus"] = strip.shear_modulus;
  return result;
}

}  // namespace

json characterisation_json(const Characterisation& found) {
  json result{{"verifications", json::array()}};
  if (const auto& law = found.tension)
    result["tension"] = {{"curve", curve_json(law->curve)}, {"rate", law->rate}, {"band", law->band},
                         {"valid_to", law->valid_to}};
  if (found.bias) result["bias_extension"] = shear_json(*found.bias);
  if (found.frame) result["picture_frame"] = shear_json(*found.frame);
  if (const auto& law = found.compression) {
    result["compression"] = {{"factors", law->factors},     {"rates", law->rates},
                             {"times", law->times},         {"first_tip", law->first_tip},
                             {"static_tip", law->static_tip}, {"stiffness", law->stiffness},
                             {"frequency", law->frequency}, {"alpha", law->alpha},
                             {"model", {{"scale", law->model.scale}, {"tip", law->model.tip}}}};
  }
  for (const StripHistory& strip : found.strips) result["cantilever"].push_back(strip_json(strip));
  for (const ProfileLaw& profile : found.profiles) {
    json one{{"file", profile.file},
             {"length", profile.length},
             {"drop", profile.drop},
             {"moment", profile.law.strain},
             {"curvature", profile.law.stress}};
    if (!profile.material.strain.empty())
      one["material"] = {{"drop", profile.material_drop}, {"curvature", profile.material.stress}};
    result["profile"].push_back(one);
  }
  for (const Verification& v : found.verifications) {
    json one{{"name", v.name},
             {"file", v.file},
             {"compared", v.what == Compared::force ? "force" : "drop"},
             {"compared_from", v.compared_from},
             {"compared_to", v.compared_to}};
    if (v.failure.empty())
      one["error"] = v.error, one["end_error"] = v.end_error;
    else
      one["failure"] = v.failure;
    result["verifications"].push_back(one);
  }
  result["material"] = material_json(found.material);
  return result;
}

std::string characterisation_text(const Characterisation& found) {
  std::string text;
  const auto mode = [&](const char* name, const CurveFields& fields) {
    text += fmt::format("{}: {}\n", name, fields.source.empty() ? "no source" : fields.source);
  };
  mode("tension", found.material.tension);
  mode("shear", found.material.shear);
  mode("compression", found.material.compression);
  for (const StripHistory& strip : found.strips) {
    if (!strip.shear_modulus.empty())
      text += fmt::format("cantilever of {:g} mm: {}; the material has {:.2g} MPa\n", 1e3 * strip.tips.length,
                          shear_modulus_text(strip), 1e-6 * found.material.transverse_shear_modulus);
  }
  for (const ProfileLaw& profile : found.profiles)
    text += fmt::format("profile of {:g} mm: {}\n", 1e3 * profile.length, profile_text(profile));
  for (const Verification& v : found.verifications) text += fmt::format("{}, simulated: {}\n", v.name, verdict(v));
  return text;
}

void write_characterisation(const std::filesystem::path& folder, const Tests& tests,
                            const Characterisation& found) {
  write_text(folder / "material.json", dump_json(material_json(found.material), 2) + "\n");
  PlanReport page;
  page.title = tests.name;
  page.description = tests.source;
  const char* measure = tests.shear_measure == 0 ? "conjugate" : "force";
  if (found.tension) page.figures.push_back(tension_figure(*found.tension));
  for (const auto& [law, what] : {std::pair<const std::optional<ShearLaw>&, const char*>{found.bias, "Bias extension"},
                                  {found.frame, "Picture frame"}}) {
    if (!law) continue;
    page.figures.push_back(force_figure(*law, what));
    page.figures.push_back(stress_figure(*law, what, measure));
  }
  for (const StripHistory& strip : found.strips) page.figures.push_back(strip_figure(strip));
  for (const ProfileLaw& profile : found.profiles) page.figures.push_back(profile_figure(profile));
  if (found.compression) page.figures.push_back(bending_figure(*found.compression));
  for (const Verification& v : found.verifications) page.figures.push_back(verification_figure(v));
  page.facts = {{"tension", found.material.tension.source},
                {"shear", found.material.shear.source},
                {"compression", found.material.compression.source}};
  page.files = {{"material.json", "the material, for the `material` of a case"},
                {"result.json", "all figures"}};
  write_text(folder / "characterisation.html", html_report(page));
}

}  // namespace drapeplan
