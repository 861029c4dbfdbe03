#include "planner/study/runner.hpp"

#include <fmt/format.h>

#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <system_error>

#include "fem/core/hash.hpp"
#include "mapping/error.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/statistics.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/search/evaluation_log.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr double kShort = 1;  // runs below it are repeated [s]

constexpr std::string_view kHead = "{\"format\":\"drapeplan-study-1\",\"case_hash\":\"";

/// The first line of a log: all runs are of this case, each with settings of its own.
std::string head_line(const Case& definition) {
  return fmt::format("{}{}\"}}", kHead, hex(case_hash(definition)));
}

double number(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// Visits all numbers of a run: one list for writing and reading.
template <class Run, class Visit>
void for_each_number(Run& run, const Visit& visit) {
  visit("wall_seconds", run.wall_seconds);
  visit("cpu_seconds", run.cpu_seconds);
  visit("element_updates", run.element_updates);
  visit("steps", run.steps);
  visit("dt", run.dt);
  visit("balance_error", run.balance_error);
  visit("kinetic_ratio", run.kinetic_ratio);
  visit("objective", run.objective);
}

json to_json(const StudyRun& run) {
  json out{{"valid", run.valid}, {"reason", run.reason}};
  for_each_number(run, [&](const char* key, double value) { out[key] = finite(value); });
  for (const auto& [name, value] : run.figures) out["figures"][name] = finite(value);
  for (const Eigen::Vector3d& place : run.places)
    out["places"].push_back({finite(place.x()), finite(place.y()), finite(place.z())});
  for (const double shear : run.shear_deg) out["shear_deg"].push_back(finite(shear));
  return out;
}

StudyRun from_json(const json& in) {
  StudyRun run;
  run.valid = in.at("valid").get<bool>();
  run.reason = in.at("reason").get<std::string>();
  for_each_number(run, [&](const char* key, double& value) { value = number(in.at(key)); });
  if (in.contains("figures")) {
    for (const auto& [name, value] : in["figures"].items()) run.figures[name] = number(value);
  }
  if (!in.contains("places")) return run;
  for (const json& place : in["places"])
    run.places.emplace_back(number(place[0]), number(place[1]), number(place[2]));
  for (const json& shear : in["shear_deg"]) run.shear_deg.push_back(number(shear));
  return run;
}

}  // namespace

StudyRunner::StudyRunner(const StudySubject& subject, StudyRunnerOptions options,
                         std::function<void(const std::string&, int, int)> progress)
    : subject_(subject), options_(std::move(options)), progress_(std::move(progress)) {
  if (options_.log.empty()) return;
  const std::string head = head_line(subject_.whole());
  std::error_code error;
  std::uintmax_t whole = 0;
  if (std::filesystem::exists(options_.log, error)) {
    whole = read_log(head);
    std::filesystem::resize_file(options_.log, whole, error);  // a line that a killed study left half written
  }
  if (!error) file_.open(options_.log, std::ios::binary | std::ios::app);
  if (whole == 0) file_ << head << '\n' << std::flush;
  if (error || !file_) throw NotFinished(options_.log.string() + ": cannot be written");
}

/// @return length of the whole lines [bytes].
std::uintmax_t StudyRunner::read_log(const std::string& head) {
  const auto refuse = [this](int number, const std::string& fault) {
    throw WrongInput(
        fmt::format("{}:{}: {}; leave out --resume to begin anew", options_.log.string(), number, fault));
  };
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(options_.log, error)) in.open(options_.log, std::ios::binary);
  if (!in.is_open()) throw WrongInput(options_.log.string() + ": cannot be read as the log of a study");
  std::uintmax_t whole = 0;
  int number = 0;
  for (std::string line; std::getline(in, line); whole += line.size() + 1) {
    const bool torn = in.eof();
    ++number;
    if (number == 1 && !(torn ? head.starts_with(line) : head == line))
      refuse(number, line.starts_with(kHead) ? "is the log of another case" : "is no log of a study");
    if (torn) break;
    if (number == 1) continue;
    try {
      const json entry = checked_json(line);
      known_[entry.at("key").get<std::string>()] = from_json(entry.at("run"));
    } catch (const std::exception&) {
      refuse(number, "is no run of a study");
    }
  }
  return whole;
}

/// Of the complete case and the schedule, so that no change of either is served from the log.
std::string StudyRunner::key_of(const StudyJob& job) const {
  std::uint64_t hash = 0;
  try {
    hash = case_hash(subject_.with(job.settings));
  } catch (const std::invalid_argument& error) {
    Fnv1a text;
    text.add(std::string_view(error.what()));
    hash = text.value();
  }
  return fmt::format("{}-{}", hex(hash), hex(schedule_hash(job.schedule)));
}

StudyRun StudyRunner::measured(const StudyJob& job) const {
  std::vector<Schedule> schedules;
  if (subject_.drapes()) schedules.push_back(job.schedule);
  StudyRun run = subject_.run(job.settings, schedules).front();
  std::vector<double> wall{run.wall_seconds}, cpu{run.cpu_seconds};
  while (run.valid && run.wall_seconds < kShort && int(wall.size()) < options_.repeats) {
    const StudyRun again = subject_.run(job.settings, schedules).front();
    wall.push_back(again.wall_seconds);
    cpu.push_back(again.cpu_seconds);
  }
  run.wall_seconds = median(wall);
  run.cpu_seconds = median(cpu);
  return run;
}

void StudyRunner::keep(const std::string& key, const StudyRun& run) {
  known_[key] = run;
  if (!file_.is_open()) return;
  file_ << dump_json({{"key", key}, {"run", to_json(run)}}) << '\n';
  if (!file_.flush()) throw NotFinished(options_.log.string() + ": cannot be written (disk full?)");
}

std::vector<StudyRun> StudyRunner::run(const std::string& what, const std::vector<StudyJob>& jobs) {
  std::vector<std::string> keys;
  std::vector<size_t> missing;
  std::set<std::string> asked;
  for (size_t k = 0; k < jobs.size(); ++k) {
    keys.push_back(key_of(jobs[k]));
    if (known_.count(keys.back()) == 0 && asked.insert(keys.back()).second) missing.push_back(k);
  }
  std::mutex mutex;
  int done = 0;
  parallel_for(
      int(missing.size()),
      [&](int k) {
        const StudyRun run = measured(jobs[missing[size_t(k)]]);
        const std::lock_guard<std::mutex> lock(mutex);
        keep(keys[missing[size_t(k)]], run);
        if (progress_) progress_(what, ++done, int(missing.size()));
      },
      options_.threads);
  std::vector<StudyRun> runs;
  for (const std::string& key : keys) runs.push_back(known_.at(key));
  return runs;
}

}  // namespace drapeplan
