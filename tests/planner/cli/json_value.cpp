// Reads one value of a JSON file, for shell scripts.
// Usage: json_value FILE POINTER [LOW HIGH]
// Exit 1 if the file is not exactly one JSON document, has no such value, or its number is not within
// LOW..HIGH.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

int main(int argc, char** argv) {
  constexpr int kWithoutRange = 3, kWithRange = 5;
  if (argc != kWithoutRange && argc != kWithRange) {
    std::fprintf(stderr, "usage: json_value FILE POINTER [LOW HIGH]\n");
    return 2;
  }
  try {
    std::ifstream stream(argv[1]);
    const auto document = nlohmann::json::parse(stream);
    const nlohmann::json& value = document.at(nlohmann::json::json_pointer(argv[2]));
    std::printf("%s\n", value.is_string() ? value.get<std::string>().c_str() : value.dump().c_str());
    if (argc == kWithoutRange) return 0;
    const auto number = value.get<double>();  // throws for null, which is how NaN is written
    if (number >= std::strtod(argv[3], nullptr) && number <= std::strtod(argv[4], nullptr)) return 0;
    std::fprintf(stderr, "%s: %s: %g is not within %s..%s\n", argv[1], argv[2], number, argv[3], argv[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s: %s\n", argv[1], argv[2], error.what());
  }
  return 1;
}
