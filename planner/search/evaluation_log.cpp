#include "planner/search/evaluation_log.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "fem/core/hash.hpp"
#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "drapeplan-evaluations-1";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::uint64_t from_hex(const json& text) {
  return std::stoull(text.get<std::string>(), nullptr, 16);
}

double number_or(const json& value, double otherwise) {
  return value.is_null() ? otherwise : value.get<double>();
}

json to_json(const Evaluation& e) {
  return {{"number", e.number},
          {"stage", e.stage},
          {"fidelity", e.fidelity},
          {"schedule_hash", hex(e.schedule_hash)},
          {"objective", finite(e.outcome.score.objective)},
          {"best_so_far", finite(e.best_so_far)},
          {"wall_seconds", finite(e.outcome.wall_seconds)},
          {"score", score_json(e.outcome.score)},
          {"summary", summary_json(e.outcome.summary)}};
}

Evaluation from_json(const json& j) {
  Evaluation e;
  e.number = j.at("number").get<int>();
  e.stage = j.at("stage").get<std::string>();
  e.fidelity = j.at("fidelity").get<std::string>();
  e.schedule_hash = from_hex(j.at("schedule_hash"));
  e.best_so_far = number_or(j.at("best_so_far"), kInfinity);
  e.outcome.wall_seconds = number_or(j.at("wall_seconds"), 0);
  const json& score = j.at("score");
  const json& summary = j.at("summary");
  constexpr double kLost = std::numeric_limits<double>::quiet_NaN();
  for (const ScorePart& part : kScoreParts)
    e.outcome.score.*part.value = number_or(score.at(part.key), kLost);
  e.outcome.score.valid = score.at("valid").get<bool>();
  if (!e.outcome.score.valid) e.outcome.score.reason = score.at("reason").get<std::string>();
  const auto read_from = [&](const json& object) {
    return [&](const char* key, double& v, bool SummaryParts::*part) {
      const bool absent = part != nullptr && !object.contains(key);
      if (absent) e.outcome.summary.parts.*part = false;
      v = absent ? 0 : number_or(object.at(key), kLost);
    };
  };
  for_each_figure(e.outcome.summary, read_from(summary));
  for_each_energy(e.outcome.summary, read_from(summary.at("energy")));
  e.outcome.summary.status = summary.at("status") == "done" ? RunStatus::done : RunStatus::diverged;
  e.outcome.summary.message = summary.at("message").get<std::string>();
  e.outcome.summary.steps = summary.at("steps").get<std::int64_t>();
  e.outcome.summary.state_hash = from_hex(summary.at("state_hash"));
  return e;
}

/// Reasons may hold any bytes (an exception's text): what is not UTF-8 is replaced, never thrown over.
std::string to_line(const json& j) {
  return j.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

struct LogFile {
  std::optional<std::uint64_t> case_hash;  ///< absent: no whole first line
  std::vector<Evaluation> evaluations;
  std::uintmax_t good_bytes = 0;  ///< up to the end of the last whole line
  std::string text;
};

std::string header_line(std::uint64_t case_hash) {
  return to_line({{"format", kFormat}, {"case_hash", hex(case_hash)}});
}

LogFile read_log(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream buffer;
  buffer << in.rdbuf();
  LogFile log;
  log.text = buffer.str();
  const std::string& text = log.text;
  int line_number = 0;
  for (size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++line_number;
    try {
      const json j = json::parse(text.begin() + std::ptrdiff_t(begin), text.begin() + std::ptrdiff_t(end));
      if (line_number == 1) {
        if (j.at("format") != kFormat) throw std::runtime_error("the format is not " + std::string(kFormat));
        log.case_hash = from_hex(j.at("case_hash"));
      } else {
        log.evaluations.push_back(from_json(j));
      }
    } catch (const std::exception& error) {
      if (line_number > 1 && end + 1 == text.size()) break;  // a torn last line that happens to end the file
      throw std::runtime_error(path + ":" + std::to_string(line_number) +
                               ": not an evaluation log: " + error.what());
    }
    log.good_bytes = end + 1;
  }
  return log;
}

}  // namespace

std::uint64_t schedule_hash(const Schedule& schedule) {
  Fnv1a hash;
  const auto add_double = [&hash](double value) { hash.add(value == 0 ? 0.0 : value); };
  add_double(schedule.blend_time);
  hash.add(std::uint64_t(schedule.paths.size()));
  for (const auto& path : schedule.paths) {
    hash.add(std::uint64_t(path.size()));
    for (const Knot& knot : path) {
      add_double(knot.time);
      add_double(knot.z);
    }
  }
  for (const auto& path : schedule.plane_paths) {
    hash.add(std::uint64_t(path.size()));
    for (const PlaneKnot& knot : path) {
      for (const double value : {knot.time, knot.xy.x(), knot.xy.y()}) add_double(value);
    }
  }
  for (const auto& time : schedule.release) add_double(time.value_or(-1));
  return hash.value();
}

EvaluationLog::EvaluationLog(const std::string& path, std::uint64_t case_hash) {
  if (std::filesystem::exists(path)) read(path, case_hash);
  const bool fresh = !std::filesystem::exists(path) || std::filesystem::file_size(path) == 0;
  file_.open(path, std::ios::binary | std::ios::app);
  if (fresh) file_ << header_line(case_hash) << std::flush;
  if (!file_) throw std::runtime_error(path + ": cannot be written");
}

void EvaluationLog::read(const std::string& path, std::uint64_t case_hash) {
  LogFile log = read_log(path);
  if (!log.case_hash && !header_line(case_hash).starts_with(log.text)) {
    throw std::runtime_error(path + ": is not an evaluation log, and is left as it is");
  }
  if (log.case_hash && *log.case_hash != case_hash) {
    throw std::runtime_error(path + ": belongs to another case (hash " + hex(*log.case_hash) +
                             ", this case has " + hex(case_hash) + "); choose another folder or remove it");
  }
  for (Evaluation& evaluation : log.evaluations) remember(std::move(evaluation));
  std::filesystem::resize_file(path, log.good_bytes);
}

void EvaluationLog::remember(Evaluation evaluation) {
  known_[{evaluation.schedule_hash, evaluation.fidelity}] = evaluation.outcome;
  best_[evaluation.fidelity] = evaluation.best_so_far;
  lines_.push_back(std::move(evaluation));
}

Outcome EvaluationLog::evaluate_once(const Schedule& schedule, const std::string& fidelity,
                                     const std::function<Outcome()>& run) {
  const Key key{schedule_hash(schedule), fidelity};
  {
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [&] { return !running_.contains(key); });
    if (const auto found = known_.find(key); found != known_.end()) {
      Outcome outcome = found->second;
      outcome.cached = true;
      return outcome;
    }
    running_.insert(key);
  }
  const Outcome outcome = run();
  {
    const std::scoped_lock lock(mutex_);
    known_[key] = outcome;
    running_.erase(key);
  }
  finished_.notify_all();
  return outcome;
}

void EvaluationLog::write(const Schedule& schedule, const std::string& fidelity, const std::string& stage,
                          const Outcome& outcome) {
  const std::scoped_lock lock(mutex_);
  double best = best_.contains(fidelity) ? best_[fidelity] : kInfinity;
  if (outcome.score.valid && outcome.score.objective < best) best = outcome.score.objective;
  const int number = lines_.empty() ? 1 : lines_.back().number + 1;
  Evaluation evaluation{number, stage, fidelity, schedule_hash(schedule), outcome, best};
  if (file_.is_open()) {
    file_ << to_line(to_json(evaluation)) << std::flush;
    if (!file_) throw std::runtime_error("the evaluation log cannot be written (disk full?)");
  }
  remember(std::move(evaluation));
}

std::vector<Evaluation> EvaluationLog::evaluations() const {
  const std::scoped_lock lock(mutex_);
  return lines_;
}

std::vector<Evaluation> read_evaluations(const std::string& path) {
  return read_log(path).evaluations;
}

}  // namespace drapeplan
