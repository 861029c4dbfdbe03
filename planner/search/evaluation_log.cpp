#include "planner/search/evaluation_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "fem/core/hash.hpp"
#include "mapping/error.hpp"
#include "planner/base/base64.hpp"
#include "planner/base/json_text.hpp"
#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "drapeplan-evaluations-2";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::uint64_t from_hex(const json& text) {
  return std::stoull(text.get<std::string>(), nullptr, 16);
}

/// "2026-11-29T15:37:00Z"
std::string utc_now() {
  return fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
}

json to_json(const Evaluation& e) {
  json line{{"number", e.number},
            {"stage", e.stage},
            {"fidelity", e.fidelity},
            {"schedule_hash", hex(e.schedule_hash)},
            {"objective", finite(e.outcome.score.objective)},
            {"best_so_far", finite(e.best_so_far)},
            {"wall_seconds", finite(e.outcome.wall_seconds)},
            {"time", utc_now()},
            {"version", DRAPEPLAN_VERSION},
            {"elapsed_seconds", finite(e.outcome.elapsed)},
            {"summary", summary_json(e.outcome.summary)}};
  line["score"] = score_json(e.outcome.score);  // the one that the objective takes
  if (const auto& other = e.outcome.other) line[other->key()] = score_json(other->score);
  const std::vector<float>& fields = e.outcome.fields;
  if (!fields.empty()) {
    std::vector<unsigned char> bytes(fields.size() * sizeof(float));
    std::memcpy(bytes.data(), fields.data(), bytes.size());
    line["fields"] = base64(bytes);
  }
  return line;
}

/// As to_json writes them: 32-bit floats, the lowest byte first.
std::vector<float> fields_from(const json& text) {
  const auto bytes = bytes_of_base64(text.get_ref<const std::string&>());
  if (!bytes || bytes->size() % sizeof(float) != 0)
    throw std::invalid_argument("fields: not base64 of floats");
  std::vector<float> fields(bytes->size() / sizeof(float));
  std::memcpy(fields.data(), bytes->data(), bytes->size());
  return fields;
}

static_assert(std::endian::native == std::endian::little, "fields are written as they lie in memory");

constexpr double kLost = std::numeric_limits<double>::quiet_NaN();

Evaluation from_json(const json& j) {
  Evaluation e;
  e.number = j.at("number").get<int>();
  e.stage = j.at("stage").get<std::string>();
  e.fidelity = j.at("fidelity").get<std::string>();
  e.schedule_hash = from_hex(j.at("schedule_hash"));
  e.best_so_far = number_or(j.at("best_so_far"), kInfinity);
  e.outcome.wall_seconds = number_or(j.at("wall_seconds"), 0);
  e.outcome.elapsed = number_or(j.at("elapsed_seconds"), 0);
  const json& summary = j.at("summary");
  e.outcome.score = score_from(j.at("score"));
  if (j.contains("fields")) e.outcome.fields = fields_from(j.at("fields"));
  for (const bool before : {true, false}) {
    OtherScore other{before, {}};
    if (!j.contains(other.key())) continue;
    other.score = score_from(j.at(other.key()));
    e.outcome.other = std::move(other);
  }
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

std::string to_line(const json& j) {
  return dump_json(j) + '\n';
}

std::string header_line(std::uint64_t case_hash) {
  return to_line({{"format", kFormat}, {"case_hash", hex(case_hash)}});
}

/// The case hash of a first line. @throws std::exception if it is none.
std::uint64_t hash_of_header(const std::string& line) {
  const json header = checked_json(line);
  if (header.at("format") != kFormat)
    throw std::invalid_argument(fmt::format("the format is not {}", kFormat));
  return from_hex(header.at("case_hash"));
}

void require_case(const std::string& path, std::uint64_t found, std::uint64_t wanted) {
  if (found == wanted) return;
  throw WrongInput(
      fmt::format("{}: belongs to another case (hash {}, this case has {}), and is left as it is", path,
                  hex(found), hex(wanted)));
}

/// A first line that a killed run has not finished is the begin of the line that this case would write.
void require_begin_of_header(const std::string& path, const std::string& text,
                             std::optional<std::uint64_t> case_hash) {
  if (text.empty() || (case_hash && header_line(*case_hash).starts_with(text))) return;
  throw WrongInput(path + ": is not an evaluation log, and is left as it is");
}

}  // namespace

double value_of(const Outcome& outcome) {
  const bool good = outcome.score.valid && std::isfinite(outcome.score.objective);
  return good ? outcome.score.objective : kInfinity;
}

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

std::uint64_t candidate_hash(std::uint64_t design, const Schedule& schedule) {
  if (design == 0) return schedule_hash(schedule);
  Fnv1a hash;
  hash.add(design);
  hash.add(schedule_hash(schedule));
  return hash.value();
}

std::uintmax_t read_evaluations(const std::string& path, std::optional<std::uint64_t> case_hash,
                                const std::function<void(Evaluation&&)>& visit) {
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, error)) in.open(path, std::ios::binary);  // a pipe would block
  if (!in.is_open()) throw WrongInput(path + ": cannot be read as a log of evaluations");
  std::uintmax_t whole = 0;
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    const bool torn = in.eof();
    ++line_number;
    if (torn && line_number == 1) require_begin_of_header(path, line, case_hash);
    if (torn) break;
    const bool last = in.peek() == std::ifstream::traits_type::eof();
    std::uint64_t found = 0;
    std::optional<Evaluation> evaluation;
    try {
      if (line_number == 1) {
        found = hash_of_header(line);
      } else {
        evaluation = from_json(checked_json(line));
      }
    } catch (const std::exception& fault) {
      if (line_number > 1 && last) break;  // a torn last line that happens to end in a line break
      throw WrongInput(
          fmt::format("{}:{}: is no line of an evaluation log: {}", path, line_number, fault.what()));
    }
    if (line_number == 1) require_case(path, found, case_hash.value_or(found));
    if (evaluation && visit) visit(std::move(*evaluation));
    whole += line.size() + 1;
  }
  return whole;
}

std::vector<Evaluation> read_evaluations(const std::string& path, std::optional<std::uint64_t> case_hash) {
  std::vector<Evaluation> evaluations;
  read_evaluations(path, case_hash, [&](Evaluation&& one) { evaluations.push_back(std::move(one)); });
  return evaluations;
}

EvaluationLog::EvaluationLog(const std::string& path, std::uint64_t case_hash) : path_(path) {
  std::error_code error;
  std::uintmax_t whole = 0;
  if (std::filesystem::exists(path, error)) {
    whole = read_evaluations(path, case_hash, [this](Evaluation&& one) { remember(one); });
    std::filesystem::resize_file(path, whole, error);
  }
  before_ = latest_;
  if (!error) file_.open(path, std::ios::binary | std::ios::app);
  if (whole == 0) file_ << header_line(case_hash) << std::flush;
  if (error || !file_) throw NotFinished(path + ": cannot be written");
}

void EvaluationLog::remember(const Evaluation& evaluation) {
  known_[{evaluation.schedule_hash, evaluation.fidelity}] = evaluation.outcome;
  best_[evaluation.fidelity] = evaluation.best_so_far;
  last_number_ = evaluation.number;
  latest_ = std::max(latest_, evaluation.outcome.elapsed);
  ++size_;
}

void EvaluationLog::use_settings(std::uint64_t settings) {
  const std::scoped_lock lock(mutex_);
  settings_ = settings;
}

Outcome EvaluationLog::evaluate_once(std::uint64_t candidate, const std::string& fidelity,
                                     const std::function<Outcome()>& run) {
  const Key key{candidate ^ settings_, fidelity};
  {
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [&] { return !running_.contains(key); });
    if (const auto found = known_.find(key); found != known_.end()) {
      Outcome outcome = found->second;
      outcome.cached = true;
      return outcome;
    }
    running_.insert(key);
    if (!begin_) begin_ = std::chrono::steady_clock::now();
  }
  std::optional<Outcome> outcome;
  const auto end = [&] {
    {
      const std::scoped_lock lock(mutex_);
      if (outcome) known_[key] = *outcome;
      running_.erase(key);
    }
    finished_.notify_all();
  };
  try {
    outcome = run();
    outcome->elapsed = elapsed();
  } catch (...) {
    end();  // whoever waits for it runs it himself
    throw;
  }
  end();
  return *outcome;
}

void EvaluationLog::write(std::uint64_t candidate, const std::string& fidelity, const std::string& stage,
                          const Outcome& outcome) {
  const std::scoped_lock lock(mutex_);
  double best = best_.contains(fidelity) ? best_[fidelity] : kInfinity;
  if (outcome.score.valid && outcome.score.objective < best) best = outcome.score.objective;
  const Evaluation evaluation{last_number_ + 1, stage, fidelity, candidate ^ settings_, outcome, best};
  if (file_.is_open()) {
    file_ << to_line(to_json(evaluation)) << std::flush;
    if (!file_) throw NotFinished(path_ + ": cannot be written (disk full?)");
  }
  remember(evaluation);
}

double EvaluationLog::elapsed() const {
  const std::scoped_lock lock(mutex_);
  if (!begin_) return before_;
  return before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - *begin_).count();
}

int EvaluationLog::size() const {
  const std::scoped_lock lock(mutex_);
  return size_;
}

}  // namespace drapeplan
