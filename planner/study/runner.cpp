#include "planner/study/runner.hpp"

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "fem/core/hash.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/statistics.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr double kShort = 1;  // runs below it are repeated [s]

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
  if (options_.resume) {
    read_log();
  } else if (std::filesystem::exists(options_.log)) {  // hours of work: never lost by a forgotten option
    std::filesystem::rename(options_.log, options_.log.string() + ".old");
  }
  file_.open(options_.log, options_.resume ? std::ios::app : std::ios::trunc);
  if (!file_) throw std::runtime_error(options_.log.string() + ": cannot be written");
}

/// A torn last line (of a study that was killed) is cut off.
void StudyRunner::read_log() {
  std::ifstream in(options_.log);
  int number = 0;
  std::uintmax_t good = 0;  // bytes of whole lines
  for (std::string line; std::getline(in, line);) {
    ++number;
    const bool torn = in.eof();
    if (torn) break;
    try {
      const json entry = checked_json(line);
      known_[entry.at("key").get<std::string>()] = from_json(entry.at("run"));
    } catch (const std::exception&) {
      throw std::invalid_argument(options_.log.string() + ":" + std::to_string(number) +
                                  ": is no run of a study; remove this line or leave out --resume");
    }
    good += line.size() + 1;
  }
  in.close();
  if (std::filesystem::exists(options_.log)) std::filesystem::resize_file(options_.log, good);
}

/// Of the complete case and the schedule, so that no change of either is served from the log.
std::string StudyRunner::key_of(const StudyJob& job) const {
  Fnv1a hash;
  std::string text;
  try {
    json resolved = resolved_case(subject_.with(job.settings));
    for (const char* words : {"description", "references", "optimise"}) resolved.erase(words);
    text = dump_json(resolved);
  } catch (const std::invalid_argument& error) {
    text = error.what();
  }
  hash.add(std::string_view(text));
  return hex(hash.value()) + "-" + hex(schedule_hash(job.schedule));
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
  if (!file_.flush()) throw std::runtime_error(options_.log.string() + ": cannot be written");
}

std::vector<StudyRun> StudyRunner::run(const std::string& what, const std::vector<StudyJob>& jobs) {
  std::vector<std::string> keys;
  std::vector<size_t> todo;
  std::set<std::string> asked;
  for (size_t k = 0; k < jobs.size(); ++k) {
    keys.push_back(key_of(jobs[k]));
    if (known_.count(keys.back()) == 0 && asked.insert(keys.back()).second) todo.push_back(k);
  }
  std::mutex mutex;
  int done = 0;
  parallel_for(
      int(todo.size()),
      [&](int k) {
        const StudyRun run = measured(jobs[todo[size_t(k)]]);
        const std::lock_guard<std::mutex> lock(mutex);
        keep(keys[todo[size_t(k)]], run);
        if (progress_) progress_(what, ++done, int(todo.size()));
      },
      options_.threads);
  std::vector<StudyRun> runs;
  for (const std::string& key : keys) runs.push_back(known_.at(key));
  return runs;
}

}  // namespace drapeplan
