#include "planner/molds/spline_text.hpp"

#include <bit>
#include <cstring>
#include <vector>

#include "planner/base/base64.hpp"

namespace drapeplan {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes of doubles are copied as they are");

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

std::string coefficient_text(const Eigen::MatrixXd& coefficients) {
  const RowMajor rows = coefficients;
  std::vector<unsigned char> bytes(size_t(rows.size()) * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), rows.data(), bytes.size());
  return base64(bytes);
}

std::optional<Eigen::MatrixXd> coefficients_of(const std::string& text, int rows, int columns) {
  const std::optional<std::vector<unsigned char>> bytes = bytes_of_base64(text);
  if (!bytes || bytes->size() != size_t(rows) * size_t(columns) * sizeof(double)) return {};
  RowMajor numbers(rows, columns);
  std::memcpy(numbers.data(), bytes->data(), bytes->size());
  if (!numbers.allFinite()) return {};
  return Eigen::MatrixXd(numbers);
}

}  // namespace drapeplan
