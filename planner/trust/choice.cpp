#include "planner/trust/choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/statistics.hpp"
#include "planner/schedule/families.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Error of a knob that could not be turned [-].
constexpr double kUnknownError = 1;
/// Reports that a search makes at a time (search/stages.cpp).
constexpr int kReportsSideBySide = 2;

/// A combination of levels, one of each knob.
struct Combination {
  FemOptions options;
  double error = kInfinity, objective_error = kInfinity;
  double updates = 0;  ///< of the elements in a run: its cost, whatever the machine does meanwhile
  double seconds = 0;  ///< of a run on one core [s]
};

class Chooser {
 public:
  Chooser(const Case& definition, SettingRunner& runner, int threads)
      : case_(definition), runner_(runner), threads_(threads), frame_(DrapeProblem(definition).frame()) {
    baselines_ = spread_schedules(frame_, 2);
    base_.options = case_.fidelities.at(kSearched.front());
  }

  FidelityChoice choose() {
    begin();
    // Fibre inertia makes steps long, and some drapes unstable: where one fails, all begin again with half of
    // it.
    while (!turn_all() && base_.options.fibre_mass_scaling > 1) {
      base_.options.fibre_mass_scaling = std::max(1.0, std::floor(0.5 * base_.options.fibre_mass_scaling));
      begin();
    }
    combine();
    pick_report();
    pick_screen();
    pick_search();
    // Those of the ladder were found after `report`, the cheapest first.
    std::rotate(choice_.chosen.begin(), choice_.chosen.begin() + 1, choice_.chosen.end());
    choice_.runs = runner_.runs();
    choice_.seconds = runner_.elapsed();
    return std::move(choice_);
  }

 private:
  /// The baselines where everything is cheap: on a finer mesh where the outline asks for it, slower where a
  /// ply is thrown, with less fibre inertia where a run fails.
  void begin() {
    while (!(base_ = runner_.run(base_.options, baselines_)).valid()) {
      FemOptions& options = base_.options;
      const bool ended =
          std::all_of(base_.outcomes.begin(), base_.outcomes.end(),
                      [](const Outcome& outcome) { return outcome.summary.status == RunStatus::done; });
      const bool built = std::any_of(base_.outcomes.begin(), base_.outcomes.end(),
                                     [](const Outcome& outcome) { return outcome.summary.steps > 0; });
      if (!built && options.mesh_size > case_.fidelities.at(kReport).mesh_size) {
        options.mesh_size = std::max(0.5 * options.mesh_size, case_.fidelities.at(kReport).mesh_size);
      } else if (options.time_scaling > 1 && (ended || options.fibre_mass_scaling <= 1)) {
        options.time_scaling = std::max(1.0, 0.5 * options.time_scaling);
      } else if (options.fibre_mass_scaling > 1) {
        options.fibre_mass_scaling = std::max(1.0, std::floor(0.5 * options.fibre_mass_scaling));
      } else {
        throw NotFinished("no numerical setting was found at which both baselines can be simulated: " +
                          reason_of(base_));
      }
    }
  }

  /// Every knob from cheap to careful. False if a run failed that was more careful than the base.
  bool turn_all() {
    knobs_.clear();
    choice_.levels.clear();
    const FemOptions base = base_.options;
    const double slow = case_.fidelities.at(kReport).time_scaling;
    return turn(&FemOptions::time_scaling, {2 * base.time_scaling, base.time_scaling, slow, 0.5 * slow}) &&
           turn(&FemOptions::fibre_mass_scaling, {2 * base.fibre_mass_scaling, base.fibre_mass_scaling, 2}) &&
           turn_rates() &&
           turn(&FemOptions::mesh_size,
                {base.mesh_size, base.mesh_size / 2, base.mesh_size / 3, base.mesh_size / 4});
  }

  static std::string reason_of(const SettingRuns& runs) {
    for (const Outcome& outcome : runs.outcomes)
      if (!outcome.score.valid) return outcome.score.reason;
    return {};
  }

  /// So many runs, each of so many updates and seconds, fit into what the choice may take. With a budget of
  /// evaluations it may take what its share of them would cost at this setting.
  [[nodiscard]] bool affords(double updates, double seconds, int runs) const {
    const OptimiseOptions& optimise = case_.optimise;
    if (optimise.evaluations > 0)
      return runner_.updates() + runs * updates <= kChoiceShare * optimise.evaluations * updates;
    const double rounds = std::ceil(runs / double(std::min(threads_, runs)));
    return runner_.elapsed() + rounds * seconds <= kChoiceShare * optimise.budget;
  }

  /// Values of a knob from cheap to careful; each costs at least as the one before by the ratio of values,
  /// and cells by its third power.
  bool turn(double FemOptions::*knob, std::vector<double> values) {
    const double base = base_.options.*knob;
    if (knob == &FemOptions::time_scaling)
      for (double& value : values) value = std::max(value, 1.0);
    std::sort(values.begin(), values.end(), std::greater<>());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    std::vector<SettingRuns> tried;
    for (const double value : values) {
      FemOptions options = base_.options;
      options.*knob = value;
      if (value == base) {
        tried.push_back(base_);
        continue;
      }
      const bool known = std::any_of(tried.begin(), tried.end(),
                                     [&](const SettingRuns& p) { return p.options.*knob < base; });
      if (known) {  // without one that is more careful than the base nothing would be known of the knob
        const double power = knob == &FemOptions::mesh_size ? 3 : 1;
        const SettingRuns& before = tried.back();
        const double factor = std::pow(before.options.*knob / value, power);
        if (!affords(factor * before.updates, factor * before.seconds, int(baselines_.size()))) break;
      }
      tried.push_back(runner_.run(options, baselines_));
      if (value < base && !tried.back().valid() && base_.options.fibre_mass_scaling > 1) return false;
    }
    add_levels(knob, tried);
    return true;
  }

  /// Whether the material's rates count. Without tables at several rates there is nothing to turn.
  bool turn_rates() {
    std::vector<SettingRuns> tried{base_};
    const Fabric& fabric = case_.material;
    const bool has_rates = fabric.tension.curves.size() > 1 || fabric.compression.curves.size() > 1 ||
                           fabric.shear.curves.size() > 1;
    if (has_rates) {
      FemOptions options = base_.options;
      options.rates = true;
      tried.push_back(runner_.run(options, baselines_));
      if (!tried.back().valid() && base_.options.fibre_mass_scaling > 1) return false;
    }
    add_levels(nullptr, tried);
    return true;
  }

  void add_levels(double FemOptions::*knob, const std::vector<SettingRuns>& tried) {
    if (knob == &FemOptions::mesh_size) mesh_levels_ = knobs_.size();
    std::vector<Level> levels;
    for (const SettingRuns& runs : tried) {
      Level level{.knob = knob, .options = runs.options, .updates = runs.updates, .seconds = runs.seconds};
      if (!runs.valid()) level.error = level.objective_error = kInfinity;
      levels.push_back(level);
    }
    const auto is_valid = [](const SettingRuns& runs) { return runs.valid(); };
    const auto careful =
        std::find_if(tried.rbegin(), tried.rend(), is_valid);  // the last that ran to its end
    const auto before = std::find_if(careful + 1, tried.rend(), is_valid);
    levels[size_t(tried.rend() - careful - 1)].careful = true;
    // Rates as they are, the schedule's own clock and no added mass are exact. Where the end is not reached,
    // the last step is the error. And what comes closer than something finer does so by chance. Of a knob
    // that could not be turned nothing is known.
    const bool exact = !knob || (knob != &FemOptions::mesh_size && careful->options.*knob == 1);
    double error = 0, objective_error = 0;
    if (!exact && before == tried.rend()) error = objective_error = kUnknownError;
    if (!exact && before != tried.rend()) {
      error = difference(*before, *careful, case_.score);
      objective_error = objective_difference(*before, *careful);
    }
    for (auto runs = careful; runs != tried.rend(); ++runs) {
      if (!runs->valid()) continue;
      const double own = difference(*runs, *careful, case_.score),
                   objective = objective_difference(*runs, *careful);
      error = knob ? std::max(error, own) : own;
      objective_error = knob ? std::max(objective_error, objective) : objective;
      Level& level = levels[size_t(tried.rend() - runs - 1)];
      level.error = error;
      level.objective_error = objective_error;
    }
    knobs_.push_back(levels);
    choice_.levels.insert(choice_.levels.end(), levels.begin(), levels.end());
  }

  /// All combinations, by increasing cost.
  void combine() {
    combinations_ = {{.options = base_.options,
                      .error = 0,
                      .objective_error = 0,
                      .updates = base_.updates,
                      .seconds = base_.seconds}};
    for (const std::vector<Level>& levels : knobs_) {
      std::vector<Combination> grown;
      for (const Combination& before : combinations_) {
        for (const Level& level : levels) {
          Combination next = before;
          if (level.knob) next.options.*level.knob = level.options.*level.knob;
          if (!level.knob) next.options.rates = level.options.rates;
          // Curves at rates are steeper: more fibre inertia than in the base makes drapes unstable with them.
          if (next.options.rates && next.options.fibre_mass_scaling > base_.options.fibre_mass_scaling)
            continue;
          next.error += level.error;
          next.objective_error += level.objective_error;
          next.updates *= level.updates / base_.updates;
          // An update costs more on a small mesh; but times are noisy, so only meshes are told apart by them.
          const bool mesh = level.knob == &FemOptions::mesh_size;
          next.seconds *= mesh ? level.seconds / base_.seconds : level.updates / base_.updates;
          grown.push_back(next);
        }
      }
      combinations_ = std::move(grown);
    }
    std::stable_sort(combinations_.begin(), combinations_.end(),
                     [](const Combination& a, const Combination& b) { return a.updates < b.updates; });
  }

  /// Other schedules than the baselines are shorter and bend the ply more: what is wilder than the base may
  /// do for screening, where it is tried with more of them.
  [[nodiscard]] bool calm(const Combination& one) const {
    return one.options.time_scaling <= base_.options.time_scaling &&
           one.options.fibre_mass_scaling <= base_.options.fibre_mass_scaling;
  }

  /// The cheapest combination within the error; else the one with the least error, and of several the finest
  /// mesh.
  template <class Allowed>
  [[nodiscard]] std::optional<Combination> cheapest(double error, const Allowed& allowed) const {
    std::optional<Combination> best;
    for (const Combination& one : combinations_) {
      if (!std::isfinite(one.error) || !calm(one) || !allowed(one)) continue;
      if (one.error <= error) return one;
      const auto rank = [](const Combination& c) { return std::pair(c.error, c.options.mesh_size); };
      if (!best || rank(one) < rank(*best)) best = one;
    }
    return best;
  }

  void pick_report() {
    const OptimiseOptions& optimise = case_.optimise;
    const auto any = [](const Combination&) { return true; };
    const Combination wanted = *cheapest(kReportError, any);  // the base is calm, and it ran
    const int runs = 2 + optimise.finalists + 1;
    const double rounds = std::ceil(double(runs) / std::min(threads_, kReportsSideBySide));
    const auto paid = [&](const Combination& one) {
      return optimise.evaluations > 0 || rounds * one.seconds <= kReportsShare * optimise.budget;
    };
    const Combination report = cheapest(kReportError, paid).value_or(*cheapest(kInfinity, any));
    keep(kReport, report, std::numeric_limits<double>::quiet_NaN());
    report_updates_ = report.updates;
    if (report.error <= kReportError) return;
    if (report.error >= kUnknownError) {
      choice_.message =
          "by how much results at `report` are off could not be measured: runs that would tell fail";
      return;
    }
    choice_.message =
        fmt::format("results at `report` may be off by {:.1f} %, more than the {:.0f} % that are wanted",
                    1e2 * report.error, 1e2 * kReportError);
    if (wanted.error < report.error)
      choice_.message +=
          fmt::format("; a budget of {:.0f} min would pay for {:.1f} %",
                      std::ceil(rounds * wanted.seconds / kReportsShare / 60), 1e2 * wanted.error);
  }

  /// A cheap combination that ranks schedules as the finest mesh does that the choice can pay for.
  void pick_screen() {
    const std::vector<Level>& meshes = knobs_[mesh_levels_];
    const int more = kRanked - int(baselines_.size());
    for (auto mesh = meshes.rbegin(); mesh != meshes.rend() && !careful_; ++mesh) {
      if (std::isfinite(mesh->error) && mesh->updates > base_.updates &&
          affords(mesh->updates, mesh->seconds, more))
        careful_ = runner_.run(mesh->options, spread_schedules(frame_, kRanked));
    }
    if (!careful_) return;
    choice_.ranked_against = setting_text(careful_->options);
    // What is tried next is clearly better, or has less fibre inertia where that made a drape unstable.
    double most_error = kInfinity, most_fibre_mass = kInfinity;
    for (const Combination& one : combinations_) {
      if (one.updates > 0.5 * report_updates_) break;
      if (!(one.error < most_error) || !(one.options.fibre_mass_scaling < most_fibre_mass)) continue;
      if (!affords(one.updates, one.seconds, kRanked)) break;
      const SettingRuns tried = runner_.run(one.options, spread_schedules(frame_, kRanked));
      if (const double ranks = ranks_of(tried, *careful_); ranks >= kScreenRanks) {
        keep(kSearched.front(), one, ranks);
        screen_ = one;
        return;
      }
      if (tried.valid()) most_error = 0.5 * one.error;
      if (!tried.valid()) most_fibre_mass = one.options.fibre_mass_scaling;
    }
  }

  /// One between `screen` and `report`, if there is room for it.
  void pick_search() {
    if (!screen_) return;
    const double wanted = std::min(kSearchError, 0.5 * screen_->error);
    for (const Combination& one : combinations_) {
      const bool between = one.updates >= 2 * screen_->updates && one.updates <= 0.5 * report_updates_;
      if (!between || one.error > wanted || !calm(one)) continue;
      if (!affords(one.updates, one.seconds, kRanked)) return;
      const double ranks = ranks_of(runner_.run(one.options, spread_schedules(frame_, kRanked)), *careful_);
      if (ranks >= kScreenRanks) keep(kSearched.back(), one, ranks);
      return;
    }
  }

  /// Spearman's correlation over the schedules that both could score; what only the careful one could counts
  /// as ranked wrongly.
  [[nodiscard]] static double ranks_of(const SettingRuns& cheap, const SettingRuns& careful) {
    const std::vector<double> cheap_objectives = cheap.objectives(),
                              careful_objectives = careful.objectives();
    std::vector<double> x, y;
    int failed = 0;
    for (size_t k = 0; k < cheap_objectives.size(); ++k) {
      if (std::isnan(careful_objectives[k])) continue;
      if (std::isnan(cheap_objectives[k])) {
        ++failed;
        continue;
      }
      x.push_back(cheap_objectives[k]);
      y.push_back(careful_objectives[k]);
    }
    constexpr size_t kFewest = 4;  // of less a correlation says nothing
    return x.size() < kFewest ? 0 : spearman(x, y) * double(x.size()) / double(x.size() + size_t(failed));
  }

  void keep(const char* name, const Combination& one, double ranks) {
    choice_.chosen.push_back({name, one.options, one.error, one.objective_error, ranks, one.seconds});
  }

  const Case& case_;
  SettingRunner& runner_;
  int threads_;
  SequenceFrame frame_;
  std::vector<Schedule> baselines_;
  SettingRuns base_;
  std::vector<std::vector<Level>> knobs_;
  size_t mesh_levels_ = 0;  ///< where among them
  std::vector<Combination> combinations_;
  std::optional<SettingRuns> careful_;  ///< that ranks are compared with
  std::optional<Combination> screen_;
  double report_updates_ = 0;
  FidelityChoice choice_;
};

}  // namespace

FidelityChoice choose_fidelities(const Case& definition, EvaluationLog& log, int threads,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const Progress&)>& progress) {
  SettingRunner runner(definition, log, threads, stop, progress);
  return Chooser(definition, runner, thread_count(threads)).choose();
}

std::map<std::string, FemOptions> FidelityChoice::fidelities() const {
  std::map<std::string, FemOptions> map;
  for (const ChosenFidelity& one : chosen) map[one.name] = one.options;
  return map;
}

}  // namespace drapeplan
