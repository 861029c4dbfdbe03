// Coefficients of a spline as text, exact to the bit, for cases that are written out.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace drapeplan {

/// Base64 of the numbers as little-endian doubles [m], those along y fastest.
std::string coefficient_text(const Eigen::MatrixXd& coefficients);

/// Nothing if the text does not hold rows by columns finite numbers. @param rows, columns  at least 1.
std::optional<Eigen::MatrixXd> coefficients_of(const std::string& text, int rows, int columns);

}  // namespace drapeplan
