#include "planner/reach/ipopt.hpp"

#include <fmt/format.h>

#include <IpIpoptApplication.hpp>
#include <IpIpoptData.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>

#include "planner/reach/ipopt_lock.hpp"

namespace drapeplan {
namespace {

constexpr double kTolerance = 1e-11;  // of optimality and constraints; lengths are in units of the spacing
constexpr int kMaxIterations = 300;   // a solvable problem takes 10 to 30
constexpr double kMaxCpuSeconds = 5;  // of the whole process, all threads: a guard against a hang only

using Ipopt::Index;
using Ipopt::Number;

Eigen::Map<const Eigen::VectorXd> view(const Number* values, Index n) {
  return {values, n};
}

/// Hands finite values over; not finite ones tell Ipopt to shorten its step (the mold ends there).
bool give(const Eigen::VectorXd& values, Number* result) {
  std::copy(values.begin(), values.end(), result);
  return values.allFinite();
}

void give_pattern(const ReachNlp::Pattern& pattern, Index* rows, Index* columns) {
  for (const auto& [row, column] : pattern) {
    *rows++ = row;
    *columns++ = column;
  }
}

class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(const ReachNlp& nlp, const Eigen::VectorXd& start, IpoptOutcome& outcome)
      : nlp_(nlp), start_(start), outcome_(outcome) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = nlp_.variables();
    m = nlp_.constraints();
    jacobian = Index(nlp_.jacobian_pattern().size());
    hessian = Index(nlp_.hessian_pattern().size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* g_lower,
                       Number* g_upper) override {
    const ReachNlp::Bounds x = nlp_.variable_bounds(), g = nlp_.constraint_bounds();
    std::copy(x.lower.begin(), x.lower.end(), x_lower);  // Ipopt takes bounds beyond 1e19 for none
    std::copy(x.upper.begin(), x.upper.end(), x_upper);
    std::copy(g.lower.begin(), g.lower.end(), g_lower);
    std::copy(g.upper.begin(), g.upper.end(), g_upper);
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    return give(start_, x);
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = nlp_.objective(view(x, n));
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    return give(nlp_.gradient(view(x, n)), gradient);
  }

  bool eval_g(Index n, const Number* x, bool, Index, Number* values) override {
    return give(nlp_.constraint_values(view(x, n)), values);
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values != nullptr) return give(nlp_.jacobian_values(view(x, n)), values);
    give_pattern(nlp_.jacobian_pattern(), rows, columns);
    return true;
  }

  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    if (values != nullptr) return give(nlp_.hessian_values(view(x, n), sigma, view(multipliers, m)), values);
    give_pattern(nlp_.hessian_pattern(), rows, columns);
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    outcome_.variables = view(x, n);
  }

 private:
  const ReachNlp& nlp_;
  const Eigen::VectorXd& start_;
  IpoptOutcome& outcome_;
};

std::string in_words(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "solved";
    case Ipopt::Solved_To_Acceptable_Level:
      return "solved to a looser tolerance only";
    case Ipopt::Infeasible_Problem_Detected:
      return "no position with all pads on the mold keeps the interlinks' lengths";
    case Ipopt::Restoration_Failed:
      return "the search for a position that keeps all constraints failed";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "iteration limit reached";
    case Ipopt::Maximum_CpuTime_Exceeded:
      return "time limit reached";
    case Ipopt::Invalid_Number_Detected:
      return "the mold is not defined where the search went";
    case Ipopt::Diverging_Iterates:
      return "the search diverged";
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return "more constraints than freedoms";
    default:
      return fmt::format("Ipopt ended with code {}", int(status));
  }
}

}  // namespace

std::mutex& ipopt_mutex() {
  static std::mutex mutex;
  return mutex;
}

IpoptOutcome minimise(const ReachNlp& nlp, const Eigen::VectorXd& start) {
  IpoptOutcome outcome;
  outcome.variables = start;
  const std::lock_guard<std::mutex> lock(ipopt_mutex());

  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);  // no console
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetNumericValue("tol", kTolerance);
  application->Options()->SetNumericValue("constr_viol_tol", kTolerance);
  application->Options()->SetIntegerValue("max_iter", kMaxIterations);
  application->Options()->SetNumericValue("max_cpu_time", kMaxCpuSeconds);
  application->Options()->SetStringValue("nlp_scaling_method",
                                         "none");  // the variables are of order 1 already
  // An empty name: by default an ipopt.opt in the working directory would change the result.
  const Ipopt::ApplicationReturnStatus ready = application->Initialize("");
  if (ready != Ipopt::Solve_Succeeded) {
    outcome.status = in_words(ready);
    return outcome;
  }
  const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(new Adapter(nlp, start, outcome));
  outcome.converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  outcome.status = in_words(status);
  return outcome;
}

}  // namespace drapeplan
