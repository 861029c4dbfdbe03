#include "planner/tables/smooth.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace drapeplan {
namespace {

void check_increasing(const std::vector<double>& x, const char* what) {
  if (x.size() < 2) throw std::invalid_argument(std::string(what) + ": needs two values at least");
  for (size_t k = 1; k < x.size(); ++k) {
    if (!(x[k] > x[k - 1])) throw std::invalid_argument(std::string(what) + ": must increase");
  }
}

/// Index of the piece between two of the values that holds x; the first or last one outside.
size_t piece_of(const std::vector<double>& values, double x) {
  const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, x);
  return size_t(above - values.begin()) - 1;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)) {
  check_increasing(x_, "MonotoneCubic");
  if (x_.size() != y_.size()) throw std::invalid_argument("MonotoneCubic: as many values as places");
  const size_t n = x_.size();
  std::vector<double> secant;
  for (size_t k = 0; k + 1 < n; ++k) secant.push_back((y_[k + 1] - y_[k]) / (x_[k + 1] - x_[k]));
  slopes_.assign(n, 0);
  slopes_.front() = secant.front();
  slopes_.back() = secant.back();
  for (size_t k = 1; k + 1 < n; ++k) {
    const double before = secant[k - 1], after = secant[k];
    if (before * after <= 0) continue;
    const double h0 = x_[k] - x_[k - 1], h1 = x_[k + 1] - x_[k];
    const double share = (h0 + 2 * h1) / (3 * (h0 + h1));
    slopes_[k] = before * after / (share * after + (1 - share) * before);
  }
}

size_t MonotoneCubic::piece(double x) const {
  return piece_of(x_, x);
}

double MonotoneCubic::operator()(double x) const {
  if (x <= x_.front()) return y_.front() + slopes_.front() * (x - x_.front());
  if (x >= x_.back()) return y_.back() + slopes_.back() * (x - x_.back());
  const size_t k = piece(x);
  const double h = x_[k + 1] - x_[k], t = (x - x_[k]) / h, s = 1 - t;
  return y_[k] * s * s * (1 + 2 * t) + y_[k + 1] * t * t * (3 - 2 * t) +
         h * s * t * (slopes_[k] * s - slopes_[k + 1] * t);
}

double MonotoneCubic::slope(double x) const {
  if (x <= x_.front()) return slopes_.front();
  if (x >= x_.back()) return slopes_.back();
  const size_t k = piece(x);
  const double h = x_[k + 1] - x_[k], t = (x - x_[k]) / h, s = 1 - t;
  return 6 * s * t * (y_[k + 1] - y_[k]) / h + slopes_[k] * s * (1 - 3 * t) + slopes_[k + 1] * t * (1 - 3 * s);
}

std::vector<double> not_decreasing(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double mean, weight;
    size_t count;
  };
  std::vector<Pool> pools;
  for (size_t k = 0; k < values.size(); ++k) {
    pools.push_back({values[k], weights[k], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& pool = pools.back();
      const double weight = pool.weight + last.weight;
      pool = {(pool.mean * pool.weight + last.mean * last.weight) / weight, weight, pool.count + last.count};
    }
  }
  std::vector<double> result;
  for (const Pool& pool : pools) result.insert(result.end(), pool.count, pool.mean);
  return result;
}

double value_between(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto reached = std::lower_bound(x.begin() + 1, x.end() - 1, at);
  const auto k = size_t(reached - x.begin());
  const double rise = x[k] - x[k - 1];
  const double share = rise > 0 ? std::clamp((at - x[k - 1]) / rise, 0.0, 1.0) : 0;
  return y[k - 1] + share * (y[k] - y[k - 1]);
}

std::vector<double> fit_at_knots(const std::vector<double>& x, const std::vector<double>& y,
                                 const std::vector<double>& knots, double first) {
  check_increasing(knots, "fit_at_knots");
  if (x.size() != y.size()) throw std::invalid_argument("fit_at_knots: as many values as places");
  const auto n = Eigen::Index(knots.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (size_t p = 0; p < x.size(); ++p) {
    const size_t k = piece_of(knots, x[p]);
    const double t = (x[p] - knots[k]) / (knots[k + 1] - knots[k]);
    if (t < 0 || t > 1) continue;
    const auto i = Eigen::Index(k);
    normal(i, i) += (1 - t) * (1 - t);
    normal(i, i + 1) += t * (1 - t);
    normal(i + 1, i) += t * (1 - t);
    normal(i + 1, i + 1) += t * t;
    right[i] += (1 - t) * y[p];
    right[i + 1] += t * y[p];
  }
  constexpr double kPrice = 1e-6;  // of a point: decides only where there is none
  for (Eigen::Index k = 1; k + 1 < n; ++k) {
    const double a = knots[size_t(k)] - knots[size_t(k) - 1], b = knots[size_t(k) + 1] - knots[size_t(k)];
    const Eigen::Vector3d bend = Eigen::Vector3d(b, -(a + b), a) / (a + b);
    normal.block<3, 3>(k - 1, k - 1) += kPrice * bend * bend.transpose();
  }
  right.tail(n - 1) -= first * normal.col(0).tail(n - 1);
  const Eigen::VectorXd rest = normal.bottomRightCorner(n - 1, n - 1).ldlt().solve(right.tail(n - 1));
  std::vector<double> values{first};
  values.insert(values.end(), rest.begin(), rest.end());
  return values;
}

double rms_miss(const std::vector<double>& x, const std::vector<double>& y,
                const std::function<double(double)>& curve) {
  double sum = 0;
  for (size_t k = 0; k < x.size(); ++k) sum += std::pow(y[k] - curve(x[k]), 2);
  return x.empty() ? 0 : std::sqrt(sum / double(x.size()));
}

}  // namespace drapeplan
