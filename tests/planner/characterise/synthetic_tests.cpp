// Writes synthetic raw data of tests of a case's material. Usage: synthetic_tests OUT_DIR CASE [SEED]
#include <cstdlib>
#include <iostream>

#include "planner/case/file.hpp"
#include "tests/planner/characterise/synthetic.hpp"

int main(int argc, char** argv) {
  using namespace drapeplan;
  if (argc < 3) {
    std::cerr << "usage: synthetic_tests OUT_DIR CASE [SEED]\n";
    return 2;
  }
  const CaseReading reading = read_case(argv[2]);
  for (const InputError& error : reading.errors) std::cerr << error.text() << '\n';
  if (!reading.errors.empty()) return 2;
  const unsigned seed = argc > 3 ? unsigned(std::atoi(argv[3])) : 1;
  test::write_synthetic_tests(argv[1], *fields_of(reading.definition).material, {.seed = seed});
  return 0;
}
