// Solves one smooth program with Ipopt.
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>

#include "planner/reach/program.hpp"

namespace drapeplan {

/// One Ipopt at a time: to be held from the construction of an IpoptApplication to its destruction. Ipopt
/// before 3.14 calls MUMPS, which is not thread-safe, without a lock of its own.
std::mutex& ipopt_mutex();

struct IpoptSettings {
  double tolerance = 1e-11;      ///< of optimality and constraints
  int max_iterations = 300;      ///< a solvable reach problem takes 10 to 30
  double max_cpu_seconds = 5;    ///< of the whole process, all threads: a guard against a hang only
  double barrier = 0.1;          ///< the first barrier parameter; small where the start is near a solution
  double push = 1e-2;            ///< how far starts are moved away from their bounds, at most
  bool long_dual_steps = false;  ///< multipliers take the step of the bounds' multipliers
  bool minimum_degree = false;   ///< the linear solver orders by minimum degree: faster for large sparse ones
};

struct IpoptOutcome {
  bool converged = false;
  bool infeasible = false;      ///< a point where constraints cannot be met any better, near it
  std::string status;           ///< in words
  Eigen::VectorXd variables;    ///< the last iterate, whether converged or not
  Eigen::VectorXd multipliers;  ///< of the constraints there: > 0 where an upper bound holds
  int iterations = 0;
};

/// A local minimum near `start`. Holds ipopt_mutex() all the time.
IpoptOutcome minimise(const SmoothProgram& program, const Eigen::VectorXd& start,
                      const IpoptSettings& settings = {});

}  // namespace drapeplan
