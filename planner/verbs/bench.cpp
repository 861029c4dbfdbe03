// bench: throughput of named scenes, whole time steps on one core.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "fem/run/throughput.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/text.hpp"
#include "planner/drape/problem.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/schedule/strategy.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct BenchOptions {
  CommonOptions common;
  std::string file = "cases/flexdraper-5x5.json";
  std::vector<std::string> only;
  int repeats = 5;
  double seconds = 0.5;
  std::int64_t steps = 0;
};

enum class Kind { free_sheet, sheet_on_mold, drape, as_it_is };

/// The scene of this name is the case itself, with or without grippers.
constexpr const char* kCaseScene = "case";

struct BenchScene {
  std::string name;
  Kind kind = Kind::drape;
  double mesh_size = 0.005;
  int section_points = 3;
  bool rates = false;
  double fibre_mass_scaling = 1;
  Precision precision = Precision::double_lanes;
};

std::vector<BenchScene> bench_scenes() {
  return {{"free-sheet-5mm", Kind::free_sheet},
          {"sheet-on-mold-5mm", Kind::sheet_on_mold},
          {"drape-10mm", Kind::drape, 0.010},
          {"drape-5mm", Kind::drape},
          {"drape-2.5mm", Kind::drape, 0.0025},
          {"drape-5mm-1-point", Kind::drape, 0.005, 1},
          {"drape-5mm-5-points", Kind::drape, 0.005, 5},
          {"drape-5mm-rates", Kind::drape, 0.005, 3, true},
          {"drape-5mm-5-points-rates", Kind::drape, 0.005, 5, true},
          {"drape-5mm-fibre-inertia", Kind::drape, 0.005, 3, false, 4},
          {"drape-5mm-single", Kind::drape, 0.005, 3, false, 1, Precision::single_lanes}};
}

double highest(const Mold& mold) {
  constexpr int kSamples = 200;  // per side
  double top = -1e300;
  const Extent& extent = mold.extent();
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; j <= kSamples; ++j) {
      const Eigen::Vector2d share(double(i) / kSamples, double(j) / kSamples);
      const Eigen::Vector2d at = extent.lower + share.cwiseProduct(extent.upper - extent.lower);
      top = std::max(top, mold.height(at.x(), at.y()));
    }
  }
  return top;
}

Scene scene_of(const Case& definition, const BenchScene& bench) {
  FemOptions options = definition.fidelities.at(kReport);
  if (bench.kind == Kind::as_it_is) return scene_of(definition, options);
  options.mesh_size = bench.mesh_size;
  options.section_points = bench.section_points;
  options.rates = bench.rates;
  options.fibre_mass_scaling = bench.fibre_mass_scaling;
  options.precision = bench.precision;
  Scene scene = scene_of(definition, options);
  if (bench.kind != Kind::drape) {
    scene.rig.reset();
    scene.start_height = highest(*scene.mold) + scene.fabric.thickness;
  }
  if (bench.kind == Kind::free_sheet) {
    scene.mold.reset();
    scene.friction.reset();
  }
  return scene;
}

/// Throughput of as many candidates side by side, which share the model, over that of one.
double side_by_side(const Model& model, const ThroughputRequest& request, int candidates, double one) {
  std::vector<double> rate(size_t(candidates), 0.0);
  parallel_for(
      candidates, [&](int k) { rate[size_t(k)] = measure_throughput(model, request).updates_per_second; },
      candidates);
  double sum = 0;
  for (const double value : rate) sum += value;
  return sum / one;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// With counted steps nothing is timed well: their figures come without what the machine can do.
json machine_json(const BenchOptions& options) {
  constexpr size_t kSmall = 16 << 10, kMiddle = 512 << 10, kLarge = 256 << 20;
  json machine = {{"processor", processor()}, {"lanes", kLanes}};
  if (options.steps > 0) return machine;
  machine["fma_peak_gflops"] = 1e-9 * fma_peak();
  machine["stream_16KiB_GBps"] = 1e-9 * stream_rate(kSmall);
  machine["stream_512KiB_GBps"] = 1e-9 * stream_rate(kMiddle);
  machine["stream_256MiB_GBps"] = 1e-9 * stream_rate(kLarge);
  return machine;
}

json scene_json(const BenchScene& bench, const Model& model, const Throughput& measured) {
  const FemOptions& fem = model.scene().options;
  return {{"name", bench.name},
          {"terms", model.term_names()},
          {"mesh_size", fem.mesh_size},
          {"section_points", fem.section_points},
          {"rates", fem.rates},
          {"precision", fem.precision == Precision::single_lanes ? "single" : "double"},
          {"elements", model.scene().mesh.element_count()},
          {"nodes", model.node_count()},
          {"steps", measured.steps},
          {"element_updates_per_second", measured.updates_per_second},
          {"spread", measured.spread},
          {"kernel_flops_per_update", kernel_flops(fem.section_points, fem.fibre_points)},
          {"bytes_per_update", step_bytes(model)},
          {"state_hash", hex(measured.state_hash)},
          {"same_hash_in_all_repeats", measured.same_hash}};
}

json measure_scene(const Case& definition, const BenchScene& bench, const Schedule& schedule,
                   const BenchOptions& options) {
  constexpr double kStart = 0.05;      // of the schedule [s]: warm, and every scene still moves freely
  constexpr double kFirstStep = 1e-9;  // with --steps [s]: counted runs are slow, and need no warming up
  constexpr double kEnd = 10;          // of the scenes without grippers [s]
  const Model model(scene_of(definition, bench));
  const bool timed = options.steps == 0;
  const double peak = timed ? fma_peak() : 0;  // measured anew: the clock may have changed
  const ThroughputRequest request{.schedule = model.rig() ? &schedule : nullptr,
                                  .duration = model.rig() ? 0 : kEnd,
                                  .start = timed ? kStart : kFirstStep,
                                  .seconds = options.seconds,
                                  .steps = options.steps,
                                  .repeats = options.repeats};
  const Throughput measured = measure_throughput(model, request);
  json entry = scene_json(bench, model, measured);
  if (!timed) return entry;
  const Footprint bytes = measure_footprint(model.scene());
  entry["model_bytes"] = bytes.model;
  entry["state_bytes"] = bytes.state;
  entry["workspace_bytes"] = bytes.workspace;
  entry["updates_per_second_per_gflops"] = measured.updates_per_second / (1e-9 * peak);
  const int lanes = model.scene().options.precision == Precision::single_lanes ? 2 : 1;  // floats per double
  entry["share_of_peak"] =
      entry["kernel_flops_per_update"].get<double>() * measured.updates_per_second / (lanes * peak);
  if (bench.name == "drape-5mm")
    entry["two_side_by_side"] = side_by_side(model, request, 2, measured.updates_per_second);
  return entry;
}

/// A number that is left out with counted steps.
double number(const json& object, const char* key) {
  return object.value(key, std::numeric_limits<double>::quiet_NaN());
}

/// What the machine can do, and the heads of the columns of `scene_line`.
std::string heading(const json& machine) {
  return fmt::format(
             "{}, {} lanes of double: {:.1f} GFLOP/s; streams {:.0f}, {:.0f}, {:.0f} GB/s (16 KiB, 512 KiB, "
             "256 "
             "MiB)\n\n",
             machine["processor"].get<std::string>(), kLanes, number(machine, "fma_peak_gflops"),
             number(machine, "stream_16KiB_GBps"), number(machine, "stream_512KiB_GBps"),
             number(machine, "stream_256MiB_GBps")) +
         fmt::format("{:<26} {:>9} {:>9} {:>12} {:>8} {:>9} {:>9}\n", "scene", "elements", "M/s",
                     "M/s per GF/s", "spread", "of peak", "GB/s");
}

std::string scene_line(const json& scene) {
  const auto name = scene["name"].get<std::string>();
  const double rate = number(scene, "element_updates_per_second");
  if (!scene.contains("share_of_peak")) {  // counted steps: the figure that means something is the state
    return fmt::format("{}: {} steps, state hash {}\n", name, scene["steps"].get<std::int64_t>(),
                       scene["state_hash"].get<std::string>());
  }
  std::string text = fmt::format(
      "{:<26} {:9} {:9.2f} {:12.3f} {:7.1f}% {:8.1f}% {:9.1f}\n", name, scene["elements"].get<int>(),
      1e-6 * rate, 1e-6 * number(scene, "updates_per_second_per_gflops"), 1e2 * number(scene, "spread"),
      1e2 * number(scene, "share_of_peak"), 1e-9 * rate * number(scene, "bytes_per_update"));
  if (scene.contains("two_side_by_side")) {
    text += fmt::format("{:<26} {:>9} {:9.2f} times the throughput of one\n", "  two on two cores", "",
                        number(scene, "two_side_by_side"));
  }
  return text;
}

std::string csv(const json& result) {
  std::string text =
      "machine,scene,mesh_size_m,section_points,rates,precision,elements,Mupdates_per_s,Mupdates_per_s_per_"
      "GFLOPps,"
      "spread,state_hash\n";
  for (const json& s : result["scenes"]) {
    text += fmt::format("{},{},{:g},{},{},{},{},{:.2f},{:.4f},{:.3f},{}\n",
                        result["machine"]["processor"].get<std::string>(), s["name"].get<std::string>(),
                        s["mesh_size"].get<double>(), s["section_points"].get<int>(),
                        int(s["rates"].get<bool>()), s["precision"].get<std::string>(),
                        s["elements"].get<int>(), 1e-6 * s["element_updates_per_second"].get<double>(),
                        1e-6 * number(s, "updates_per_second_per_gflops"), s["spread"].get<double>(),
                        s["state_hash"].get<std::string>());
  }
  return text;
}

/// The scenes named by --scene, or all but the case itself. @throws WrongInput for a name that none has.
std::vector<BenchScene> chosen_scenes(const std::vector<std::string>& names) {
  std::vector<BenchScene> all = bench_scenes();
  if (names.empty()) return all;
  all.push_back({kCaseScene, Kind::as_it_is});
  std::vector<std::string> known;
  for (const BenchScene& scene : all) known.push_back(scene.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw WrongInput(
        fmt::format("--scene: there is no scene \"{}\"; there are {}", name, fmt::join(known, " ")));
  }
  std::vector<BenchScene> chosen;
  for (const BenchScene& scene : all) {
    if (std::find(names.begin(), names.end(), scene.name) != names.end()) chosen.push_back(scene);
  }
  return chosen;
}

/// The uniform schedule of a case with grippers; of another, none.
Schedule uniform_schedule(const Case& definition) {
  if (!definition.grippers) return {};
  const DrapeProblem problem(definition);
  return to_schedule(problem.frame(), uniform_strokes(problem.frame()));
}

int bench(const BenchOptions& options) {
  const std::vector<BenchScene> scenes = chosen_scenes(options.only);
  const bool as_it_is = scenes.size() == 1 && scenes.front().kind == Kind::as_it_is;
  using Sections = std::vector<std::string>;
  const Case definition =
      load_case(options.file, options.common,
                as_it_is ? Sections{"material"} : Sections{"mapping", "grippers", "material", "mold"});
  const Schedule schedule = uniform_schedule(definition);
  OutputFolder out = take_folder(options.common, "bench");
  json result = {{"machine", machine_json(options)}, {"scenes", json::array()}};
  std::string text = options.steps > 0 ? "" : heading(result["machine"]);
  bool same = true;
  for (const BenchScene& scene : scenes) {
    if (!options.common.quiet) std::cerr << scene.name << " ...\n";
    json entry = measure_scene(definition, scene, schedule, options);
    same = same && entry["same_hash_in_all_repeats"].get<bool>();
    text += scene_line(entry);
    result["scenes"].push_back(std::move(entry));
  }
  begin_output(out, options.common);
  if (!options.common.out.empty()) {
    const std::filesystem::path folder(options.common.out);
    write_text(folder / "bench.csv", csv(result));
  }
  deliver(result, text, options.common, &definition);
  if (!same) throw std::logic_error("repeats of a scene ended in different states");
  return kDone;
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
  add_verb<BenchOptions>(
      program, action, "bench", "throughput of whole time steps in named scenes, on one core",
      [](CLI::App& verb, BenchOptions& options) {
        verb.add_option("CASE", options.file,
                        "case with mold and grippers (default: cases/flexdraper-5x5.json)");
        verb.add_option("--scene", options.only,
                        "only these scenes (repeatable); `case` is the case itself, also without grippers");
        verb.add_option("--repeats", options.repeats, "of each scene; the median counts (default: 5)")
            ->check(CLI::Range(1, 1000));
        verb.add_option("--seconds", options.seconds, "that a repeat takes, about (default: 0.5)")
            ->check(CLI::Range(0.001, 1000.0));
        verb.add_option(
                "--steps", options.steps,
                "of a repeat, from the flat start, instead of --seconds: so two builds can be compared")
            ->check(CLI::Range(1, 100000000));
      },
      bench);
}

}  // namespace drapeplan
