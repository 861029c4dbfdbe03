#include "planner/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace drapeplan {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void check_pairs(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) throw std::invalid_argument("rank correlation: the lists differ in length");
  const auto is_nan = [](double value) { return std::isnan(value); };
  if (std::any_of(a.begin(), a.end(), is_nan) || std::any_of(b.begin(), b.end(), is_nan))
    throw std::invalid_argument("rank correlation: a value is not a number");
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

int sign(double value) {
  return (value > 0) - (value < 0);
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return kNan;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    for (size_t k = first; k < last; ++k) result[order[k]] = 0.5 * double(first + 1 + last);
  }
  return result;
}

double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  check_pairs(a, b);
  if (a.size() < 2) return kNan;
  const std::vector<double> rank_a = ranks(a), rank_b = ranks(b);
  const double middle = mean(rank_a);
  double ab = 0, aa = 0, bb = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    ab += (rank_a[k] - middle) * (rank_b[k] - middle);
    aa += (rank_a[k] - middle) * (rank_a[k] - middle);
    bb += (rank_b[k] - middle) * (rank_b[k] - middle);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : kNan;
}

double kendall(const std::vector<double>& a, const std::vector<double>& b) {
  check_pairs(a, b);
  double agree = 0, untied_a = 0, untied_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = i + 1; j < a.size(); ++j) {
      agree += sign(a[i] - a[j]) * sign(b[i] - b[j]);
      untied_a += a[i] != a[j];
      untied_b += b[i] != b[j];
    }
  }
  return untied_a > 0 && untied_b > 0 ? agree / std::sqrt(untied_a * untied_b) : kNan;
}

NoiseEstimate difference_noise(const std::vector<double>& values) {
  constexpr double kAgreement = 4;  // of three levels, as in More and Wild (2011)
  if (values.size() < 4) throw std::invalid_argument("difference_noise: needs at least four values");
  std::vector<double> differences = values, level_noise;
  std::vector<char> changes_sign;
  double share = 1;  // (k!)^2 / (2k)!
  for (size_t k = 1; k < values.size(); ++k) {
    double squares = 0;
    bool up = false, down = false;
    for (size_t i = 0; i + 1 < differences.size(); ++i) {
      differences[i] = differences[i + 1] - differences[i];
      squares += differences[i] * differences[i];
      up = up || differences[i] > 0;
      down = down || differences[i] < 0;
    }
    differences.pop_back();
    share *= double(k) / double(2 * (2 * k - 1));
    level_noise.push_back(std::sqrt(share * squares / double(differences.size())));
    changes_sign.push_back(up && down);
  }
  for (size_t k = 0; k + 2 < level_noise.size(); ++k) {
    const auto [low, high] = std::minmax({level_noise[k], level_noise[k + 1], level_noise[k + 2]});
    if (high <= kAgreement * low && changes_sign[k]) return {level_noise[k], int(k) + 1, true};
  }
  const auto smallest = std::min_element(level_noise.begin(), level_noise.end());
  return {*smallest, int(smallest - level_noise.begin()) + 1, false};
}

double observed_order(const std::vector<double>& size, const std::vector<double>& error, double r) {
  std::vector<double> sizes, logs;
  for (size_t k = 0; k < std::min(size.size(), error.size()); ++k) {
    if (!(size[k] > r && error[k] > 0) || !std::isfinite(size[k]) || !std::isfinite(error[k])) continue;
    sizes.push_back(size[k]);
    logs.push_back(std::log(error[k]));
  }
  if (sizes.size() < 2) return kNan;
  const double unit = *std::max_element(sizes.begin(), sizes.end());
  if (!(*std::min_element(sizes.begin(), sizes.end()) < unit)) return kNan;  // one size tells no order
  const auto scatter = [&](double p) {
    std::vector<double> ratio;
    for (size_t k = 0; k < sizes.size(); ++k)
      ratio.push_back(logs[k] - std::log(std::pow(sizes[k] / unit, p) - std::pow(r / unit, p)));
    const double middle = mean(ratio);
    double sum = 0;
    for (const double value : ratio) sum += (value - middle) * (value - middle);
    return sum;
  };
  constexpr double kLargest = 8, kStep = 0.01;
  double best = kStep;
  for (double p = 2 * kStep; p <= kLargest; p += kStep) {
    if (scatter(p) < scatter(best)) best = p;
  }
  return best > 2 * kStep && best < kLargest - 2 * kStep
             ? best
             : kNan;  // at a limit of the search there is no order
}

std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<int> order;
  for (size_t k = 0; k < std::min(cost.size(), error.size()); ++k) {
    if (std::isfinite(cost[k]) && std::isfinite(error[k])) order.push_back(int(k));
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(cost[size_t(a)], error[size_t(a)]) < std::pair(cost[size_t(b)], error[size_t(b)]);
  });
  std::vector<int> front;
  for (const int k : order) {
    if (front.empty() || error[size_t(k)] < error[size_t(front.back())]) front.push_back(k);
  }
  return front;
}

}  // namespace drapeplan
