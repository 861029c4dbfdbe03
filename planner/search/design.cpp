#include "planner/search/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "fem/core/hash.hpp"
#include "mapping/error.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/case/design.hpp"
#include "planner/case/file.hpp"
#include "planner/method/cmaes.hpp"
#include "planner/schedule/check.hpp"
#include "planner/schedule/families.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

/// First step, in units of the ranges: designs are asked for over their whole range, waves are cheap to move.
constexpr double kSigma = 0.2;
constexpr double kMiddle =
    0.5;  // where a search starts for a field whose value is not in the variable's unit

/// The value at a path of a case, as JSON; null if it is absent.
json value_at(const json& resolved, const std::string& path) {
  const json* here = &resolved;
  for (size_t from = 0; from <= path.size();) {
    const size_t dot = std::min(path.find('.', from), path.size());
    const std::string part = path.substr(from, dot - from);
    const bool index = here->is_array() && !part.empty() && part.find_first_not_of("0123456789") == part.npos;
    if (index && part.size() < 9 && std::stoul(part) < here->size()) {
      here = &(*here)[std::stoul(part)];
    } else if (here->is_object() && here->contains(part)) {
      here = &(*here)[part];
    } else {
      return nullptr;
    }
    from = dot + 1;
  }
  return *here;
}

/// As people write it, and as an override takes it.
std::string text_of(const json& value) {
  return value.is_string() ? value.get<std::string>() : dump_json(value);
}

/// Where a field's value lies in the range of its variable; the middle if it does not, or is no number.
double share_of(const DesignVariable& variable, const json& value) {
  const std::string text = text_of(value);
  const std::optional<DesignRange> now = range_of({variable.path, text, text});
  const DesignRange range = *range_of(variable);
  if (!now || now->unit != range.unit) return kMiddle;
  const double share = (now->from - range.from) / (range.to - range.from);
  return share >= 0 && share <= 1 ? share : kMiddle;
}

/// A case with overrides, made ready. @throws WrongInput with the first thing that is wrong; NotFinished.
std::shared_ptr<const DrapeProblem> problem_with(const DrapeProblem& base,
                                                 const std::vector<std::string>& overrides) {
  CaseReading reading = changed_case(base.definition(), overrides);
  if (!reading.errors.empty()) throw WrongInput(reading.errors.front().text());
  return std::make_shared<const DrapeProblem>(std::move(reading.definition));
}

/// A place in the joint space: shares of the design variables, then the coordinates of a wave.
class JointSpace {
 public:
  explicit JointSpace(const DrapeProblem& base)
      : base_(base), variables_(base.definition().optimise.design) {}

  [[nodiscard]] Eigen::VectorXd start() const {
    const json resolved = resolved_case(base_.definition());
    const auto n = Eigen::Index(variables_.size());
    Eigen::VectorXd x(n + WaveFamily::kDimension);
    for (Eigen::Index k = 0; k < n; ++k)
      x[k] = share_of(variables_[size_t(k)], value_at(resolved, variables_[size_t(k)].path));
    x.tail<WaveFamily::kDimension>() = WaveFamily(base_.frame()).encode(baseline_wave(base_.frame()));
    return x;
  }

  [[nodiscard]] std::vector<std::string> overrides(const Eigen::VectorXd& x) const {
    std::vector<std::string> list;
    for (size_t k = 0; k < variables_.size(); ++k)
      list.push_back(override_of(variables_[k], x[Eigen::Index(k)]));
    return list;
  }

  /// What tells candidates apart: known before anything is mapped.
  [[nodiscard]] std::uint64_t hash(const Eigen::VectorXd& x) const {
    Fnv1a hash;
    hash.add(design_hash(overrides(x)));
    for (const double coordinate : x.tail<WaveFamily::kDimension>()) hash.add(coordinate);
    return hash.value();
  }

  /// Maps, builds and drapes a candidate.
  [[nodiscard]] Outcome drape(const Eigen::VectorXd& x, const std::string& fidelity) const {
    return scored([&] {
      const auto problem = problem_with(base_, overrides(x));
      const WaveFamily family(problem->frame());
      const Schedule schedule =
          to_schedule(problem->frame(), family.decode(x.tail<WaveFamily::kDimension>()));
      require_playable(schedule, *problem->definition().grippers);
      return outcome_of(problem->run_for_objective(schedule, fidelity));
    });
  }

 private:
  const DrapeProblem& base_;
  const std::vector<DesignVariable>& variables_;
};

/// As it would be on another rig: every path is shifted to its own target there, all start at one height.
Schedule carried_over(const Schedule& schedule, const SequenceFrame& from, const SequenceFrame& to) {
  Schedule carried = schedule;
  for (size_t g = 0; g < carried.paths.size(); ++g) {
    std::vector<Knot>& path = carried.paths[g];
    path.front().z += to.start_z() - from.start_z();
    for (size_t k = 1; k < path.size(); ++k) path[k].z += to.target_z[g] - from.target_z[g];
  }
  for (size_t g = 0; g < carried.plane_paths.size(); ++g) {
    std::vector<PlaneKnot>& path = carried.plane_paths[g];
    path.front().xy += to.start_xy[g] - from.start_xy[g];
    for (size_t k = 1; k < path.size(); ++k) path[k].xy += to.target_xy[g] - from.target_xy[g];
  }
  return carried;
}

}  // namespace

std::uint64_t design_hash(const std::vector<std::string>& overrides) {
  Fnv1a hash;
  for (const std::string& text : overrides) hash.add(std::string_view(text));
  return hash.value();
}

DesignResult search_design(const DrapeProblem& base, const std::string& fidelity, EvaluationLog& log,
                           int threads, const std::function<void(int, double)>& progress,
                           const std::function<bool()>& stop) {
  const JointSpace space(base);
  const OptimiseOptions& optimise = base.definition().optimise;
  CmaEsOptions options;
  options.sigma0 = kSigma;
  options.seed = optimise.seed;
  CmaEs search(space.start(), options);
  Eigen::VectorXd best = space.start();
  double lowest = std::numeric_limits<double>::infinity();
  DesignResult result;
  while (result.evaluations + search.population() <=
             std::max(optimise.design_evaluations, search.population()) &&
         search.stop_reason().empty()) {
    const Eigen::MatrixXd x = search.ask();
    std::vector<std::optional<Outcome>> outcomes(size_t(x.cols()));
    const auto drape = [&](int k) {
      if (stop && stop()) return;
      const Eigen::VectorXd place = x.col(k);
      outcomes[size_t(k)] =
          log.evaluate_once(space.hash(place), fidelity, [&] { return space.drape(place, fidelity); });
    };
    parallel_for(int(x.cols()), drape, threads);
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      const std::optional<Outcome>& outcome = outcomes[size_t(k)];
      if (!outcome) throw Interrupted();
      if (!outcome->cached) log.write(space.hash(x.col(k)), fidelity, "design", *outcome);
      values[k] = value_of(*outcome);
      if (values[k] < lowest) lowest = values[k], best = x.col(k);
    }
    search.tell(values);
    result.evaluations += int(x.cols());
    if (progress) progress(result.evaluations, lowest);
  }
  if (!std::isfinite(lowest)) throw NotFinished("no design could be draped");
  result.overrides = space.overrides(best);
  result.wave = best.tail<WaveFamily::kDimension>();
  result.problem = problem_with(base, result.overrides);
  return result;
}

void compare_changes(const DrapeProblem& base, const Schedule& best, EvaluationLog& log, int threads,
                     DesignResult& design) {
  const std::vector<DesignVariable>& variables = base.definition().optimise.design;
  const json before = resolved_case(base.definition()), after = resolved_case(design.problem->definition());
  design.changes.clear();
  for (const DesignVariable& variable : variables) {
    design.changes.push_back({variable.path,
                              text_of(value_at(before, variable.path)),
                              text_of(value_at(after, variable.path)),
                              {}});
  }
  parallel_for(
      int(variables.size()),
      [&](int k) {
        DesignChange& change = design.changes[size_t(k)];
        std::vector<std::string> others = design.overrides;
        others[size_t(k)] = change.path + "=" + change.before;
        const std::uint64_t hash = candidate_hash(design_hash(others), best);
        change.without = log.evaluate_once(hash, kReport, [&] {
          return scored([&] {
            const auto problem = problem_with(base, others);
            return outcome_of(
                problem->run(carried_over(best, design.problem->frame(), problem->frame()), kReport));
          });
        });
        if (!change.without.cached) log.write(hash, kReport, "without " + change.path, change.without);
      },
      threads);
}

}  // namespace drapeplan
