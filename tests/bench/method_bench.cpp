// Which search method finds the best schedule within a number of evaluations: all of them on the same
// subjects, from the same starts, with equal budgets. Without cases: functions of starts and heights with a
// known optimum and noise. Writes methods.csv (one line per subject, method, seed and checkpoint),
// profile.svg and traces.jsonl, from which a bench that was stopped, or that is given more seeds, goes on.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "planner/base/parallel.hpp"
#include "planner/base/statistics.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"
#include "planner/method/cmaes.hpp"
#include "planner/method/nlopt.hpp"
#include "planner/report/charts.hpp"
#include "planner/schedule/families.hpp"
#include "planner/search/plan.hpp"
#include "tests/planner/search/noise.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A subject counts as solved once this share of the way from the start to the best that any method found is all that
/// is left (J. J. More and S. M. Wild, "Benchmarking derivative-free optimization algorithms", 2009).
constexpr double kSolved = 0.1;

struct Seen {
  double value = 0;  ///< with its noise; infinite: failed
  std::vector<float> fields;
};

/// What is searched: schedules of a frame, and what they are worth.
struct Subject {
  std::string name;
  SequenceFrame frame;
  std::function<Seen(const Schedule&, unsigned seed)> told;
  std::function<double(const Schedule&)> truth;  ///< empty: what is told
  ObjectiveNear objective_near;                  ///< of the fields
  Eigen::VectorXd field_scale;
};

/// What a method showed: the true value of the best that it was told of, after each evaluation.
using Trace = std::vector<double>;

SequenceFrame flat_frame() {
  SequenceFrame frame;
  frame.rig.columns = frame.rig.rows = 5;
  frame.rig.spacing = 0.1;
  frame.target_z.assign(25, 0.05);
  return frame;
}

/// Deviations of starts [1/10 s] and heights [3 mm] from what a function likes.
Eigen::VectorXd deviations(const SequenceFrame& frame, const Schedule& schedule, double rough) {
  const int n = frame.rig.count();
  Eigen::VectorXd all(2 * n);
  for (int g = 0; g < n; ++g) {
    const Eigen::Vector2d at = frame.rig.place(g) / frame.rig.spacing;
    const auto& path = schedule.paths[size_t(g)];
    const double arrival = path[path.size() - 2].time - frame.options.preshape_duration;
    const double height = path[1].z - frame.target_z[size_t(g)];
    all[g] = arrival - (4 + 0.8 * (at - Eigen::Vector2d(-0.6, 0.8)).norm() + rough * std::sin(3.7 * g));
    all[n + g] = (height - 0.03 - 0.003 * (at.x() * at.y() + rough * 2 * std::cos(2.3 * g))) / 0.003;
  }
  return all;
}

std::vector<Subject> functions() {
  using Form = std::function<double(const Eigen::VectorXd&)>;
  const std::vector<std::pair<std::string, Form>> forms{
      {"bowl", [](const Eigen::VectorXd& d) { return d.squaredNorm(); }},
      {"kinks", [](const Eigen::VectorXd& d) { return d.lpNorm<1>() + 5 * d.lpNorm<Eigen::Infinity>(); }},
      {"valleys",
       [](const Eigen::VectorXd& d) { return (d.array().square() + 1 - (4 * d.array()).cos()).sum(); }},
      {"plateau", [](const Eigen::VectorXd& d) { return (d.cwiseAbs().array() - 0.2).cwiseMax(0.0).sum(); }}};
  std::vector<Subject> list;
  for (const double rough : {0.0, 0.5}) {
    for (const auto& [name, form] : forms) {
      Subject subject{rough > 0 ? name + ", rough" : name, flat_frame(), {}, {}, {}, {}};
      const SequenceFrame frame = subject.frame;
      const double scale = form(deviations(frame, to_schedule(frame, uniform_strokes(frame)), rough));
      subject.truth = [=, form = form](const Schedule& s) {
        return form(deviations(frame, s, rough)) / scale;
      };
      subject.told = [=, truth = subject.truth](const Schedule& s, unsigned seed) {
        constexpr double kNoise = 0.01;  // of the value, and a third of it of the start's
        const std::uint64_t hash = schedule_hash(s);
        Seen seen{truth(s) * (1 + kNoise * test::hash_noise(hash, seed)) +
                      kNoise / 3 * test::hash_noise(hash, seed + 1000),
                  {}};
        constexpr double kFieldNoise = 0.3;  // of a deviation's unit
        const Eigen::VectorXd d = deviations(frame, s, rough);
        for (Eigen::Index k = 0; k < d.size(); ++k)
          seen.fields.push_back(
              float(d[k] + kFieldNoise * test::hash_noise(hash, seed + unsigned(k) + 2000)));
        return seen;
      };
      subject.objective_near = [=, form = form](const Eigen::VectorXd&) {
        return [=](const Eigen::VectorXd& d) { return form(d) / scale; };
      };
      subject.field_scale = Eigen::VectorXd::Ones(2 * frame.rig.count());
      list.push_back(std::move(subject));
    }
  }
  return list;
}

Subject case_subject(const std::string& file) {
  CaseReading reading = read_case(file, {});
  if (!reading.errors.empty()) throw std::runtime_error(reading.errors.front().text());
  const auto problem = std::make_shared<DrapeProblem>(std::move(reading.definition));
  const std::string fidelity = plan_ladder(problem->definition()).front();
  static_cast<void>(problem->model(fidelity));
  const auto told = [problem, fidelity](const Schedule& schedule, unsigned) {
    const Drape drape = problem->run_for_objective(schedule, fidelity);
    return Seen{drape.score.valid ? drape.score.objective : kInfinity,
                problem->score_fields_of(drape, fidelity)};
  };
  const ScoreFields& fields = problem->score_fields();
  return {
      .name = problem->definition().name,
      .frame = problem->frame(),
      .told = told,
      .truth = {},
      .objective_near = [&fields](const Eigen::VectorXd& around) { return fields.objective_near(around); },
      .field_scale = fields.scale()};
}

/// Keeps the trace of whatever evaluates through it.
class Recorder {
 public:
  Recorder(const Subject& subject, unsigned seed, int budget)
      : subject_(subject), seed_(seed), budget_(budget) {}

  const Seen& evaluate(const Schedule& schedule) {
    const auto [known, fresh] = known_.try_emplace(schedule_hash(schedule));
    if (!fresh) return known->second;
    known->second = subject_.told(schedule, seed_);
    const double value = known->second.value;
    if (left() > 0) {
      if (value < best_) best_ = value, shown_ = subject_.truth ? subject_.truth(schedule) : value;
      trace_.push_back(shown_);
    }
    return known->second;
  }
  [[nodiscard]] int left() const { return budget_ - int(trace_.size()); }
  /// To the end of the budget: a method that has ended early shows no more.
  Trace trace() {
    trace_.resize(size_t(budget_), shown_);
    return trace_;
  }

 private:
  const Subject& subject_;
  unsigned seed_;
  int budget_;
  std::map<std::uint64_t, Seen> known_;
  double best_ = kInfinity, shown_ = kInfinity;
  Trace trace_;
};

/// Points that nothing is learned from.
class Sampling : public Method {
 public:
  Sampling(Eigen::Index n, bool even, unsigned seed)
      : n_(n), even_(even), bits_(seed), next_(1 + 1000 * int(seed)) {}
  const Eigen::MatrixXd& ask() override {
    point_ = even_ ? even_point(next_++, n_) : Eigen::VectorXd(n_);
    for (Eigen::Index i = 0; !even_ && i < n_; ++i) point_(i, 0) = double(bits_() >> 11) * 0x1p-53;
    return point_;
  }
  void tell(const Eigen::VectorXd&) override {}
  [[nodiscard]] std::string stop_reason() const override { return {}; }

 private:
  Eigen::Index n_;
  bool even_;
  std::mt19937_64 bits_;
  int next_;
  Eigen::MatrixXd point_;
};

/// The wave that a seed starts from: the baseline, then others.
Eigen::VectorXd start_wave(const SequenceFrame& frame, unsigned seed) {
  if (seed == 1) return WaveFamily(frame).encode(baseline_wave(frame));
  return even_point(int(seed), WaveFamily::kDimension);
}

Trace run_method(const Subject& subject, const std::string& name, unsigned seed, int budget) {
  Recorder recorder(subject, seed, budget);
  const Eigen::VectorXd wave = start_wave(subject.frame, seed);
  if (name == "default") {
    EvaluationLog log;
    StagedOptions options;
    options.optimise.evaluations = budget;
    options.optimise.seed = seed;
    options.wave = wave;
    options.threads = 1;
    options.objective_near = subject.objective_near;
    options.field_scale = subject.field_scale;
    const Evaluate evaluate = [&](const Schedule& schedule, const std::string& fidelity) {
      Outcome outcome;
      // What is shown is the best that was told; reports are not part of the comparison, and fail.
      outcome.score.objective = fidelity == kReport ? kInfinity : recorder.evaluate(schedule).value;
      if (fidelity != kReport) outcome.fields = recorder.evaluate(schedule).fields;
      outcome.score.valid = std::isfinite(outcome.score.objective);
      return outcome;
    };
    staged_search(subject.frame, options, make_batch_evaluate(evaluate, log, 1));
    return recorder.trace();
  }
  const Spread spread = name.ends_with(" each") ? Spread::each : Spread::smooth;
  const StrokeFamily family(subject.frame, {.start = spread, .height = spread});
  const Eigen::VectorXd x0 = family.encode(WaveFamily(subject.frame).decode(wave));
  const std::map<std::string, NloptAlgorithm> algorithms{
      {"cobyla", NloptAlgorithm::cobyla}, {"sbplx", NloptAlgorithm::sbplx},
      {"bobyqa", NloptAlgorithm::bobyqa}, {"direct_l", NloptAlgorithm::direct_l},
      {"crs2", NloptAlgorithm::crs2},     {"isres", NloptAlgorithm::isres},
      {"esch", NloptAlgorithm::esch}};
  std::unique_ptr<Method> method;
  if (const auto found = algorithms.find(name); found != algorithms.end())
    method =
        std::make_unique<NloptSearches>(std::vector<NloptStart>{{.x = x0, .algorithm = found->second}}, seed);
  else if (name == "random" || name == "even")
    method = std::make_unique<Sampling>(x0.size(), name == "even", seed);
  else
    method = std::make_unique<CmaEs>(x0, CmaEsOptions{.sigma0 = 0.1, .seed = seed});
  while (recorder.left() > 0 && method->stop_reason().empty()) {
    const Eigen::MatrixXd x = method->ask();
    if (x.cols() == 0) break;
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k)
      values[k] = recorder.evaluate(to_schedule(subject.frame, family.decode(x.col(k)))).value;
    method->tell(values);
  }
  return recorder.trace();
}

const std::vector<std::string> kMethods{"default",  "random", "even",  "cobyla", "sbplx",  "bobyqa",
                                        "direct_l", "crs2",   "isres", "esch",   "cma-es", "cma-es each"};

struct Options {
  std::string out;
  std::vector<std::string> files;
  int seeds = 10, evaluations = 300, threads = 0;
};

/// Traces by subject, method and seed.
using Traces = std::vector<std::vector<std::vector<Trace>>>;

/// Share of all problems (subject and seed) that each method has solved, against evaluations.
Chart profile(const Traces& traces, int budget) {
  Chart chart{.title = "Problems solved",
              .x_label = "evaluations",
              .y_label = "share of problems",
              .series = {},
              .side_legend = true};
  for (size_t m = 0; m < kMethods.size(); ++m) {
    ChartSeries series{.name = kMethods[m], .points = {}, .steps = true};
    for (int done = 1; done <= budget; ++done) {
      int solved = 0, problems = 0;
      for (const auto& by_method : traces) {
        for (size_t s = 0; s < by_method[m].size(); ++s, ++problems) {
          double lowest = kInfinity, highest = 0;
          for (const auto& by_seed : by_method) {
            lowest = std::min(lowest, by_seed[s].back());
            highest = std::max(highest, std::isfinite(by_seed[s].front()) ? by_seed[s].front() : 0);
          }
          if (by_method[m][s][size_t(done - 1)] <= lowest + kSolved * (highest - lowest)) ++solved;
        }
      }
      series.points.emplace_back(done, double(solved) / problems);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void write_results(const Options& options, const std::vector<Subject>& subjects, const Traces& traces) {
  const std::array<int, 3> marks{options.evaluations / 4, options.evaluations / 2, options.evaluations};
  std::ofstream csv(std::filesystem::path(options.out) / "methods.csv");
  csv << "subject,method,seed,evaluations,value\n";
  fmt::print("Median of {} seeds after {} evaluations\n\n| subject |", options.seeds, options.evaluations);
  for (const std::string& method : kMethods) fmt::print(" {} |", method);
  fmt::print("\n|---|");
  for (size_t m = 0; m < kMethods.size(); ++m) fmt::print("---|");
  fmt::print("\n");
  for (size_t k = 0; k < subjects.size(); ++k) {
    fmt::print("| {} |", subjects[k].name);
    for (size_t m = 0; m < kMethods.size(); ++m) {
      std::vector<double> last;
      for (size_t s = 0; s < traces[k][m].size(); ++s) {
        for (const int mark : marks)
          csv << fmt::format("\"{}\",{},{},{},{:.6g}\n", subjects[k].name, kMethods[m], s + 1, mark,
                             traces[k][m][s][size_t(mark - 1)]);
        last.push_back(traces[k][m][s].back());
      }
      fmt::print(" {:.4g} |", median(last));
    }
    fmt::print("\n");
  }
  std::ofstream(std::filesystem::path(options.out) / "profile.svg")
      << line_chart(profile(traces, options.evaluations));
}

/// Traces that are on disk, by subject, method, seed and length; finished ones are appended as they come.
class KeptTraces {
 public:
  explicit KeptTraces(const std::filesystem::path& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      const nlohmann::json one = nlohmann::json::parse(line, nullptr, false);
      if (one.is_discarded()) continue;  // the bench was killed while it wrote this line
      Trace trace;
      for (const nlohmann::json& value : one["values"])
        trace.push_back(value.is_null() ? kInfinity : value.get<double>());
      known_[{one["subject"], one["method"], one["seed"], trace.size()}] = trace;
    }
    out_.open(file, std::ios::app);
    if (!known_.empty()) out_ << '\n';  // ends a line that was cut off
  }
  [[nodiscard]] const Trace* find(const std::string& subject, const std::string& method, unsigned seed,
                                  int budget) const {
    const auto found = known_.find({subject, method, seed, size_t(budget)});
    return found == known_.end() ? nullptr : &found->second;
  }
  /// Safe to call concurrently.
  void keep(const std::string& subject, const std::string& method, unsigned seed, const Trace& trace) {
    const nlohmann::json line{
        {"subject", subject}, {"method", method}, {"seed", seed}, {"values", trace}};
    const std::scoped_lock lock(mutex_);
    out_ << line.dump() << std::endl;
    fmt::print(stderr, "{}, {}, seed {}: {:.4g}\n", subject, method, seed, trace.back());
  }

 private:
  std::map<std::tuple<std::string, std::string, unsigned, size_t>, Trace> known_;
  std::ofstream out_;
  std::mutex mutex_;
};

void run(const Options& options) {
  std::vector<Subject> subjects;
  for (const std::string& file : options.files) subjects.push_back(case_subject(file));
  if (subjects.empty()) subjects = functions();
  std::filesystem::create_directories(options.out);
  KeptTraces kept(std::filesystem::path(options.out) / "traces.jsonl");
  const int seeds = options.seeds, methods = int(kMethods.size()), count = int(subjects.size());
  Traces traces(subjects.size(),
                std::vector<std::vector<Trace>>(kMethods.size(), std::vector<Trace>(size_t(seeds))));
  parallel_for(
      count * methods * seeds,
      [&](int job) {
        const auto method = size_t(job % methods), k = size_t(job / methods % count),
                   seed = size_t(job / methods / count);
        const std::string& name = kMethods[method];
        Trace& trace = traces[k][method][seed];
        if (const Trace* known =
                kept.find(subjects[k].name, name, unsigned(seed + 1), options.evaluations)) {
          trace = *known;
          return;
        }
        trace = run_method(subjects[k], name, unsigned(seed + 1), options.evaluations);
        kept.keep(subjects[k].name, name, unsigned(seed + 1), trace);
      },
      options.threads);
  write_results(options, subjects, traces);
}

}  // namespace
}  // namespace drapeplan

int main(int argc, char** argv) {
  CLI::App app("search methods on the same subjects with equal budgets");
  drapeplan::Options options;
  app.add_option("OUT_DIR", options.out)->required();
  app.add_option("CASE", options.files, "case files, played at their cheapest fidelity");
  app.add_option("--seeds", options.seeds)->check(CLI::PositiveNumber);
  app.add_option("--evaluations", options.evaluations)->check(CLI::Range(4, 100000));
  app.add_option("--threads", options.threads);
  CLI11_PARSE(app, argc, argv);
  drapeplan::run(options);
}
