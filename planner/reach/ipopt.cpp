#include "planner/reach/ipopt.hpp"

#include <fmt/format.h>

#include <IpIpoptApplication.hpp>
#include <IpIpoptData.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

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

void give_pattern(const SmoothProgram::Pattern& pattern, Index* rows, Index* columns) {
  for (const auto& [row, column] : pattern) {
    *rows++ = row;
    *columns++ = column;
  }
}

class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(const SmoothProgram& program, const Eigen::VectorXd& start, IpoptOutcome& outcome)
      : program_(program), form_(program.form()), start_(start), outcome_(outcome) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = Index(form_.variables.lower.size());
    m = Index(form_.constraints.lower.size());
    jacobian = Index(form_.jacobian.size());
    hessian = Index(form_.hessian.size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* g_lower,
                       Number* g_upper) override {
    const SmoothProgram::Bounds &x = form_.variables, &g = form_.constraints;
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
    value = program_.objective(view(x, n), nullptr);
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    Eigen::VectorXd values;
    const double objective = program_.objective(view(x, n), &values);
    return give(values, gradient) && std::isfinite(objective);
  }

  bool eval_g(Index n, const Number* x, bool, Index, Number* values) override {
    return give(program_.constraint_values(view(x, n)), values);
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values != nullptr) return give(program_.jacobian_values(view(x, n)), values);
    give_pattern(form_.jacobian, rows, columns);
    return true;
  }

  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    if (values != nullptr)
      return give(program_.hessian_values(view(x, n), sigma, view(multipliers, m)), values);
    give_pattern(form_.hessian, rows, columns);
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index m,
                         const Number*, const Number* multipliers, Number, const Ipopt::IpoptData* data,
                         Ipopt::IpoptCalculatedQuantities*) override {
    outcome_.variables = view(x, n);
    outcome_.multipliers = view(multipliers, m);
    if (data != nullptr) outcome_.iterations = data->iter_count();
  }

 private:
  const SmoothProgram& program_;
  const SmoothProgram::Form form_;
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

void set_options(Ipopt::OptionsList& options, const IpoptSettings& settings) {
  options.SetIntegerValue("print_level", 0);
  options.SetNumericValue("tol", settings.tolerance);
  options.SetNumericValue("constr_viol_tol", settings.tolerance);
  options.SetIntegerValue("max_iter", settings.max_iterations);
  options.SetNumericValue("max_cpu_time", settings.max_cpu_seconds);
  options.SetNumericValue("mu_init", settings.barrier);
  options.SetNumericValue("bound_push", settings.push);
  options.SetNumericValue("bound_frac", settings.push);
  options.SetStringValue("nlp_scaling_method", "none");  // the variables are of order 1 already
  options.SetStringValue("alpha_for_y", settings.long_dual_steps ? "bound-mult" : "primal");
  options.SetIntegerValue("mumps_pivot_order", settings.minimum_degree ? 0 : 7);
}

}  // namespace

std::mutex& ipopt_mutex() {
  static std::mutex mutex;
  return mutex;
}

IpoptOutcome minimise(const SmoothProgram& program, const Eigen::VectorXd& start,
                      const IpoptSettings& settings) {
  IpoptOutcome outcome;
  outcome.variables = start;
  const std::lock_guard<std::mutex> lock(ipopt_mutex());

  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);  // no console
  set_options(*application->Options(), settings);
  // An empty name: by default an ipopt.opt in the working directory would change the result.
  const Ipopt::ApplicationReturnStatus ready = application->Initialize("");
  if (ready != Ipopt::Solve_Succeeded) {
    outcome.status = in_words(ready);
    return outcome;
  }
  const Ipopt::ApplicationReturnStatus status =
      application->OptimizeTNLP(new Adapter(program, start, outcome));
  outcome.converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  outcome.infeasible = status == Ipopt::Infeasible_Problem_Detected;
  outcome.status = in_words(status);
  return outcome;
}

double violation(const SmoothProgram& program, const SmoothProgram::VectorRef& v) {
  const Eigen::VectorXd c = program.constraint_values(v);
  const SmoothProgram::Bounds bounds = program.form().constraints;
  if (!c.allFinite()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int k = 0; k < c.size(); ++k)
    largest = std::max({largest, bounds.lower[k] - c[k], c[k] - bounds.upper[k]});
  return largest;
}

}  // namespace drapeplan
