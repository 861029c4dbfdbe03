// Solves one reach NLP with Ipopt.
#pragma once

#include <Eigen/Core>
#include <string>

#include "planner/reach/nlp.hpp"

namespace drapeplan {

struct IpoptOutcome {
  bool converged = false;
  std::string status;         ///< in words
  Eigen::VectorXd variables;  ///< the last iterate, whether converged or not
};

/// A local minimum near `start`, with exact gradient, Jacobian and Hessian. Holds ipopt_mutex() all the time.
IpoptOutcome minimise(const ReachNlp& nlp, const Eigen::VectorXd& start);

}  // namespace drapeplan
