// Plans a case with the library: consumer CASE.json OUT [path=value...]
#include <iostream>
#include <utility>

#include "planner/case/file.hpp"
#include "planner/search/plan.hpp"

int main(int count, char** words) {
  if (count < 3) return 2;
  drapeplan::CaseReading reading = drapeplan::read_case(words[1], {words + 3, words + count});
  for (const drapeplan::InputError& error : reading.errors) std::cerr << error.text() << '\n';
  if (!reading.errors.empty()) return 2;

  const drapeplan::DrapeProblem problem(std::move(reading.definition));
  drapeplan::OutputFolder out(words[2], "plan");
  const drapeplan::PlanResult result = drapeplan::plan(problem, out);
  std::cout << "uniform " << result.uniform.score.objective << "\nwave " << result.wave.score.objective
            << "\nbest " << result.best.score.objective << '\n';
  return result.best.score.valid ? 0 : 3;
}
