// new: a case file to start from.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"
#include "planner/verbs/new_case.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

struct NewOptions {
  CommonOptions common;
  std::string file;  ///< empty: stdout
  std::string mold = "polynomial", unit, ply = "400x300", grippers;
};

/// "400x300" as two numbers. @throws WrongInput with the example if it is not that.
std::array<double, 2> two_numbers(const std::string& option, const std::string& text,
                                  const std::string& example) {
  const size_t cross = text.find('x');
  std::array<double, 2> numbers{};
  bool good = cross != std::string::npos;
  if (good) {
    const std::array<std::string, 2> parts{text.substr(0, cross), text.substr(cross + 1)};
    for (size_t k = 0; k < parts.size(); ++k) {
      char* end = nullptr;
      numbers[k] = std::strtod(parts[k].c_str(), &end);
      good = good && !parts[k].empty() && *end == '\0' && numbers[k] > 0;
    }
  }
  if (!good)
    throw WrongInput(
        fmt::format("{}: \"{}\": expected two numbers, as in {} {}", option, text, option, example));
  return numbers;
}

/// What the options say. @throws WrongInput with what is wrong with them.
NewCase wanted_by(const NewOptions& options) {
  if (!options.common.out.empty() || !options.common.overrides.empty() || options.common.seed)
    throw WrongInput(
        "--out, --set, --seed: name the file (drapeplan new mine.json), and change its fields there");
  NewCase wanted;
  const auto ply = two_numbers("--ply", options.ply, "400x300");
  constexpr double kMillimetre = 1e-3;
  wanted.width = kMillimetre * ply[0], wanted.height = kMillimetre * ply[1];
  if (!options.grippers.empty()) {
    const auto grid = two_numbers("--grippers", options.grippers, "5x5");
    constexpr double kMost = 100;  // of a rig along one side, as the case file has it
    for (const double count : grid)
      if (count != std::floor(count) || count > kMost)
        throw WrongInput(
            fmt::format("--grippers: \"{}\": whole numbers from 1 to {:g}", options.grippers, kMost));
    wanted.columns = int(grid[0]), wanted.rows = int(grid[1]);
  }
  const size_t equals = options.mold.find('=');
  wanted.mold = options.mold.substr(0, equals);
  if (!options.unit.empty()) wanted.unit = options.unit;
  const bool of_file = wanted.mold == "stl" || wanted.mold == "height_field";
  const bool known = of_file || wanted.mold == "polynomial" || wanted.mold == "sphere";
  if (!known || of_file != (equals != std::string::npos))
    throw WrongInput(fmt::format("--mold: \"{}\": expected polynomial, sphere, stl=FILE or height_field=FILE",
                                 options.mold));
  if (of_file) wanted.mold_file = options.mold.substr(equals + 1);
  if (!of_file && !options.unit.empty())
    throw WrongInput("--unit: is that of a file; a mold that is " + wanted.mold + " has none");
  return wanted;
}

/// The case that was made is a good one, or its options are not. @throws InputErrors, WrongInput,
/// NotFinished.
/// @return what is odd about it.
std::vector<std::string> checked(nlohmann::ordered_json value, const NewCase& wanted) {
  if (!wanted.mold_file.empty()) value["mold"]["file"] = std::filesystem::absolute(wanted.mold_file).string();
  CaseReading reading = read_case_document(value, "new case");
  if (!reading.errors.empty()) throw InputErrors(reading.errors);
  std::vector<std::string> notes = std::move(reading.notes);
  for (const std::string& warning : try_case(reading.definition)) notes.push_back("warning: " + warning);
  return notes;
}

/// Writes a file that must not be there yet. @throws WrongInput, NotFinished.
void write_new(const std::string& name, const std::string& text) {
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) throw WrongInput(name + ": is there already, and is left as it is");
  if (file < 0) throw WrongInput(name + ": cannot be written: " + std::generic_category().message(errno));
  size_t done = 0;
  int fault = 0;
  while (done < text.size() && fault == 0) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count >= 0)
      done += size_t(count);
    else if (errno != EINTR)
      fault = errno;
  }
  if (::close(file) != 0 && fault == 0) fault = errno;
  if (fault == 0) return;
  ::unlink(name.c_str());
  throw NotFinished(name + ": cannot be written: " + std::generic_category().message(fault));
}

int make_new(const NewOptions& options) {
  const NewCase wanted = wanted_by(options);
  std::error_code error;
  if (!options.file.empty() && std::filesystem::exists(std::filesystem::symlink_status(options.file, error)))
    throw WrongInput(options.file + ": is there already, and is left as it is");
  const std::filesystem::path folder =
      std::filesystem::absolute(options.file.empty() ? "stdout" : options.file).parent_path();
  const nlohmann::ordered_json value = new_case(wanted, folder);
  const std::vector<std::string> notes = checked(value, wanted);
  const std::string text = case_text(value);
  if (options.file.empty()) {
    print(text, false);
    return kDone;
  }
  write_new(options.file, text);
  const nlohmann::ordered_json& rig = value["grippers"];
  std::string words =
      fmt::format("{}: a ply of {} x {} on a mold ({}), {} x {} grippers\n", options.file,
                  value["ply"]["width"].get<std::string>(), value["ply"]["height"].get<std::string>(),
                  wanted.mold, rig["columns"].get<int>(), rig["rows"].get<int>());
  for (const std::string& note : notes) words += "  " + note + "\n";
  words += fmt::format(
      "next: drapeplan check {0}\n      drapeplan simulate {0} --fidelity screen --out out/first   # one "
      "quick drape, and its page\n"
      "      drapeplan plan {0}\n",
      options.file.find(' ') == std::string::npos ? options.file : "'" + options.file + "'");
  if (options.common.json)
    print(text, true);
  else if (!options.common.quiet)
    print(words, true);
  return kDone;
}

}  // namespace

void add_new(CLI::App& program, Action& action) {
  add_verb<NewOptions>(
      program, action, "new", "writes a case file to start from",
      [](CLI::App& verb, NewOptions& options) {
        verb.add_option("FILE", options.file, "where; it must not be there yet (default: stdout)")
            ->check(
                [](const std::string& name) { return std::string(name.empty() ? "the name is empty" : ""); });
        verb.add_option("--ply", options.ply, "width and height of the ply in mm (default: 400x300)")
            ->type_name("WxH");
        verb.add_option("--grippers", options.grippers,
                        "grippers along width and height, as 5x4 (default: as many as suit the ply)")
            ->type_name("NxN");
        verb.add_option("--mold", options.mold,
                        "polynomial, sphere, stl=FILE (STL, OBJ) or height_field=FILE (default: polynomial)")
            ->type_name("MOLD");
        verb.add_option("--unit", options.unit, "what 1 in the mold's file stands for (default: 1 mm)")
            ->type_name("LENGTH");
      },
      make_new);
}

}  // namespace drapeplan
