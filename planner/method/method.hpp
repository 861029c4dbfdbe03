// What every search method is to the stages: it hands out points, and is told what they are worth.
#pragma once

#include <Eigen/Core>
#include <string>

namespace drapeplan {

/// A search over [0, 1]^n. What it hands out depends on its start and on what it was told alone: not on who
/// evaluates, nor with how many threads.
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// The next batch: n by any number, every column in the box; without columns if the search has just ended.
  virtual const Eigen::MatrixXd& ask() = 0;
  /// Values of the last batch, in its order; lower is better, not finite is a failure.
  virtual void tell(const Eigen::VectorXd& values) = 0;
  /// Why there is no point in going on; empty if there is.
  [[nodiscard]] virtual std::string stop_reason() const = 0;
};

}  // namespace drapeplan
