#include "planner/method/composite.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "planner/base/parallel.hpp"
#include "planner/method/cmaes.hpp"
#include "planner/method/normal.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Radius of the ball, r.m.s. per coordinate of a place in [0, 1]: first, smallest and largest. A step of the
/// smallest is well above the noise of a drape.
constexpr double kFirstRadius = 0.1, kSmallestRadius = 0.028, kLargestRadius = 0.14;
constexpr double kGrow = 1.2, kShrink = 0.9;
/// The part of the radius at which points lie beside what the model likes best, in coordinates of the space.
constexpr double kBeside = 0.4;
/// Batches without gain after which the ball is as at first, and batches are twice as large.
constexpr int kPatience = 25;
constexpr int kLargestBatch = 16;
/// The model is made from the nearest observations: more of them cost as the cube, and lie too far away.
constexpr size_t kNearest = 300;
/// Of the nearest of these, what they miss is taken as the model's possible errors, so many of them.
constexpr size_t kErrorPool = 40;
constexpr int kErrors = 6;
/// An error counts in proportion to the spread, but a place far away is not held to be without bounds.
constexpr double kMostSpread = 3;
/// Generations of CMA-ES over the model.
constexpr int kGenerations = 60;
/// First step of these, of the radius.
constexpr double kInnerStep = 0.3;
/// Points beside another one that are tried until one of them is possible.
constexpr int kTries = 20;
/// Price of leaving the ball, per radius, and of what is not possible: more than any objective falls on the
/// way.
constexpr double kOutside = 1e3;
/// The kernel is chosen anew when there is so much more to choose from.
constexpr double kMoreObservations = 1.15;

bool is_possible(const SearchSpace& space, const Eigen::VectorXd& point) {
  return !space.possible || space.possible(point);
}

}  // namespace

struct CompositeSearch::Expectation {
  Observation around;
  std::optional<FieldModel> model;
  std::function<double(const Eigen::VectorXd&)> objective;
  Eigen::VectorXd correction;           ///< is added to all fields
  std::vector<Eigen::VectorXd> errors;  ///< of fields where one observation is left out
  std::vector<double> spreads;          ///< of these predictions

  /// The last field is what the objective of the others does not explain.
  [[nodiscard]] double value_of(const Eigen::VectorXd& fields) const {
    const Eigen::Index last = fields.size() - 1;
    return (objective ? objective(fields.head(last)) : 0) + fields[last];
  }
  [[nodiscard]] double at(const Eigen::VectorXd& place) const {
    FieldModel::Prediction prediction = model->predict(place);
    prediction.fields += correction;
    double sum = 0;
    for (size_t k = 0; k < errors.size(); ++k) {
      const double factor = std::min(prediction.spread / spreads[k], kMostSpread);
      sum += value_of(prediction.fields + factor * errors[k]);
    }
    return errors.empty() ? value_of(prediction.fields) : sum / double(errors.size());
  }
};

CompositeSearch::CompositeSearch(ObjectiveNear objective, Eigen::VectorXd scale,
                                 const CompositeOptions& options)
    : objective_(std::move(objective)),
      scale_(std::move(scale)),
      options_(options),
      radius_(kFirstRadius),
      batch_(options.batch),
      bits_(options.seed) {}

void CompositeSearch::observe(const Eigen::VectorXd& place, int level, const std::vector<float>& fields,
                              double value) {
  if (!std::isfinite(value) || Eigen::Index(fields.size()) != scale_.size()) return;
  for (const Observation& one : seen_) {
    if (one.level == level && one.place == place) return;
  }
  Observation one{place, level, Eigen::VectorXd(Eigen::Index(fields.size()) + 1), value};
  for (size_t k = 0; k < fields.size(); ++k) one.fields[Eigen::Index(k)] = double(fields[k]);
  const Eigen::VectorXd own = one.fields.head(Eigen::Index(fields.size()));
  one.fields.tail<1>()[0] = value - (fields.empty() ? 0 : objective_(own)(own));
  if (!one.fields.allFinite()) return;
  corrected_.push_back(value_of(one));
  seen_.push_back(std::move(one));
}

double CompositeSearch::value_of(const Observation& one) const {
  if (one.level != level_ || correction_.size() == 0) return one.value;
  const Eigen::VectorXd fields = one.fields + correction_;
  const Eigen::VectorXd own = fields.head(scale_.size());
  return (scale_.size() > 0 ? objective_(own)(own) : 0) + fields[scale_.size()];
}

void CompositeSearch::set_level(int level) {
  level_ = level;
  correct({});
}

void CompositeSearch::aim_at(int level) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(scale_.size() + 1);
  int count = 0;
  for (const Observation& there : seen_) {
    if (there.level != level) continue;
    for (const Observation& here : seen_) {
      if (here.level != level_ || here.place != there.place) continue;
      sum += there.fields - here.fields;
      ++count;
    }
  }
  correct(count > 0 ? Eigen::VectorXd(sum / count) : Eigen::VectorXd());
}

void CompositeSearch::correct(Eigen::VectorXd correction) {
  correction_ = std::move(correction);
  for (size_t k = 0; k < seen_.size(); ++k) corrected_[k] = value_of(seen_[k]);
}

void CompositeSearch::narrow() {
  radius_ = kSmallestRadius;
}

bool CompositeSearch::ready() const {
  return seen_.size() >= 2 && best() != nullptr;
}

const Observation* CompositeSearch::best() const {
  const Observation* best = nullptr;
  double lowest = kInfinity;
  for (size_t k = 0; k < seen_.size(); ++k) {
    if (seen_[k].level == level_ && corrected_[k] < lowest) lowest = corrected_[k], best = &seen_[k];
  }
  return best;
}

double CompositeSearch::value_at(const Eigen::VectorXd& place) const {
  for (size_t k = 0; k < seen_.size(); ++k) {
    if (seen_[k].level == level_ && seen_[k].place == place) return corrected_[k];
  }
  return kInfinity;
}

Eigen::VectorXd CompositeSearch::best_place() const {
  if (best() == nullptr) throw std::logic_error("CompositeSearch::best_place: nothing was seen");
  return best()->place;
}

CompositeSearch::Expectation CompositeSearch::expectation() {
  Expectation e{*best(), {}, {}, correction_, {}, {}};
  if (correction_.size() == 0) e.correction = Eigen::VectorXd::Zero(scale_.size() + 1);
  const auto distance2 = [&](const Observation* one) { return (one->place - e.around.place).squaredNorm(); };
  std::vector<const Observation*> near;
  for (const Observation& one : seen_) near.push_back(&one);
  std::stable_sort(near.begin(), near.end(),
                   [&](const Observation* a, const Observation* b) { return distance2(a) < distance2(b); });
  near.resize(std::min(near.size(), kNearest));
  const bool keep =
      kernel_ && kernel_level_ == level_ && (double(seen_.size()) < kMoreObservations * double(kernel_from_));
  Eigen::VectorXd scale(scale_.size() + 1);
  scale << scale_, 0.1;
  e.model.emplace(near, scale, level_, keep ? &*kernel_ : nullptr, options_.threads);
  if (!keep) kernel_ = e.model->kernel(), kernel_from_ = seen_.size(), kernel_level_ = level_;
  if (scale_.size() > 0) e.objective = objective_((e.around.fields + e.correction).head(scale_.size()));
  std::vector<Eigen::Index> pool;
  for (size_t k = 0; k < near.size() && pool.size() < kErrorPool; ++k) {
    if (near[k]->level == level_) pool.push_back(Eigen::Index(k));
  }
  for (int k = 0; k < kErrors; ++k) {
    FieldModel::Miss error = e.model->left_out(pool[bits_() % pool.size()]);
    e.errors.push_back(std::move(error.fields));
    e.spreads.push_back(error.spread);
  }
  return e;
}

/// Whether points are possible is asked for all of them only where the best of all is not.
Eigen::VectorXd CompositeSearch::minimise(const Expectation& e, const SearchSpace& space, double radius) {
  SearchSpace everywhere = space;
  everywhere.possible = {};
  const Eigen::VectorXd best = minimise_over(e, everywhere, radius);
  return is_possible(space, best) ? best : minimise_over(e, space, radius);
}

/// The point of the ball with the lowest expectation, by CMA-ES from the best observation.
Eigen::VectorXd CompositeSearch::minimise_over(const Expectation& e, const SearchSpace& space,
                                               double radius) {
  const Eigen::VectorXd start = space.nearest_point(e.around.place);
  const double reach = radius * std::sqrt(double(e.around.place.size()));
  CmaEs inner(start, {.sigma0 = kInnerStep * reach / std::sqrt(double(space.dimension)), .seed = bits_()});
  Eigen::VectorXd best = start;
  double lowest = kInfinity;
  for (int generation = 0; generation < kGenerations && inner.stop_reason().empty(); ++generation) {
    const Eigen::MatrixXd points = inner.ask();
    Eigen::VectorXd values(points.cols());
    std::vector<char> possible(size_t(points.cols()));
    const auto expect = [&](int k) {
      const Eigen::VectorXd place = space.place(points.col(k));
      const double outside = (place - e.around.place).norm() / reach - 1;
      values[k] = e.at(place) + kOutside * std::max(outside, 0.0);
      possible[size_t(k)] = is_possible(space, points.col(k));
    };
    parallel_for(int(points.cols()), expect, options_.threads);
    for (Eigen::Index k = 0; k < points.cols(); ++k) {
      if (possible[size_t(k)] && values[k] < lowest) lowest = values[k], best = points.col(k);
      if (!possible[size_t(k)]) values[k] += kOutside;
    }
    inner.tell(values);
  }
  return best;
}

Eigen::VectorXd CompositeSearch::beside(const Eigen::VectorXd& point, const SearchSpace& space) {
  const double length = kBeside * radius_ * std::sqrt(double(space.dimension));
  Eigen::VectorXd beside;
  for (int k = 0; k < kTries; ++k) {
    Eigen::VectorXd step(space.dimension);
    for (double& x : step) x = standard_normal(bits_);
    beside = (point + step * (length / step.norm())).cwiseMax(0).cwiseMin(1);
    if (is_possible(space, beside)) break;
  }
  return beside;
}

Eigen::MatrixXd CompositeSearch::ask(const SearchSpace& space, int count) {
  if (!ready()) throw std::logic_error("CompositeSearch::ask: there is nothing to learn from");
  Eigen::MatrixXd batch(space.dimension, count > 0 ? count : batch_);
  const Expectation e = expectation();
  before_ = value_of(e.around);
  batch.col(0) = minimise(e, space, radius_);
  if (batch.cols() > 1) batch.col(1) = minimise(e, space, 0.5 * radius_);
  for (Eigen::Index k = 2; k < batch.cols(); ++k) batch.col(k) = beside(batch.col(k % 2), space);
  return batch;
}

void CompositeSearch::end_batch() {
  if (best() == nullptr) return;
  const bool gain = value_of(*best()) < before_;
  radius_ = std::clamp(radius_ * (gain ? kGrow : kShrink), kSmallestRadius, kLargestRadius);
  without_gain_ = gain ? 0 : without_gain_ + 1;
  if (without_gain_ < kPatience) return;
  without_gain_ = 0;
  radius_ = kFirstRadius;
  batch_ = std::min(2 * batch_, kLargestBatch);
}

}  // namespace drapeplan
