#include "fem/run/state_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>

#include "fem/core/hash.hpp"
#include "fem/model/fingerprint.hpp"
#include "fem/rig/played.hpp"
#include "mapping/error.hpp"

// Layout: the line kMagic, then 64-bit words, lowest byte first: the model's fingerprint, the schedule as far
// as it has been played, the state, and at the end the FNV-1a hash of all words before. Lists have their
// length before them; a schedule without paths is none.
namespace drapeplan {
namespace {

constexpr std::string_view kMagic = "drapeplan state 6\n";
constexpr size_t kWord = 8;  // bytes

void visit_fields(EitherConst<VectorField> auto& of, const auto& visit) {
  auto& [x, y, z] = of;
  visit(x), visit(y), visit(z);
}
void visit_fields(EitherConst<Knot> auto& of, const auto& visit) {
  auto& [time, z] = of;
  visit(time), visit(z);
}
void visit_fields(EitherConst<PlaneKnot> auto& of, const auto& visit) {
  auto& [time, xy] = of;
  visit(time), visit(xy);
}
void visit_fields(EitherConst<Schedule> auto& of, const auto& visit) {
  auto& [paths, blend_time, plane_paths, release] = of;
  visit(paths), visit(blend_time), visit(plane_paths), visit(release);
}

/// Writes a value to `words`, or reads it from there, with all its parts.
template <class Words, class T>
void pass(Words& words, T& value) {
  using Value = std::remove_const_t<T>;
  const auto visit = [&words](auto& part, auto... /*hashed*/) { pass(words, part); };
  if constexpr (std::is_same_v<Value, double>) {
    words.pass(value, std::type_identity<double>());
  } else if constexpr (std::is_integral_v<Value>) {
    words.pass(value, std::type_identity<std::int64_t>());
  } else if constexpr (requires { visit_fields(value, visit); }) {
    visit_fields(value, visit);
  } else if constexpr (requires { value.has_value(); }) {
    words.presence(value);
    if (value) pass(words, *value);
  } else {
    if constexpr (requires { value.capacity(); }) words.length(value);
    for (auto& item : value) pass(words, item);
  }
}

class Writer {
 public:
  void word(std::uint64_t bits) {
    for (size_t byte = 0; byte < kWord; ++byte) bytes_.push_back(char((bits >> (8 * byte)) & 0xff));
  }
  template <class As>
  void pass(const auto& value, std::type_identity<As> /*as*/) {
    word(std::bit_cast<std::uint64_t>(As(value)));
  }
  void presence(const auto& value) { word(value.has_value() ? 1 : 0); }
  void length(const auto& list) { word(list.size()); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t word() {
    if (at_ + kWord > bytes_.size()) throw std::runtime_error("ends too early");
    std::uint64_t bits = 0;
    for (size_t byte = 0; byte < kWord; ++byte)
      bits |= std::uint64_t(static_cast<unsigned char>(bytes_[at_ + byte])) << (8 * byte);
    at_ += kWord;
    return bits;
  }
  template <class T, class As>
  void pass(T& value, std::type_identity<As> /*as*/) {
    value = T(std::bit_cast<As>(word()));
  }
  template <class T>
  void presence(std::optional<T>& value) {
    if (word() != 0) value.emplace();
  }
  void length(auto& list) {
    const std::uint64_t count = word();
    if (count > bytes_.size() / kWord) throw std::runtime_error("has a list longer than itself");
    list.resize(size_t(count));
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
};

std::uint64_t checksum(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes);
  return hash.value();
}

/// Until when a state was made under its schedule: the last command that the rig saw [s, schedule's clock].
double seen_until(const Model& model, const State& state) {
  return state.step > 0 ? (state.time - state.dt_before) * model.scene().options.time_scaling : 0;
}

/// Refuses a schedule that is not the one that was played. @throws std::runtime_error
void check_schedule(const Model& model, const State& state, const Schedule& played,
                    const Schedule* schedule) {
  if (played.paths.empty() && schedule == nullptr) return;
  if (played.paths.empty() || schedule == nullptr || !model.scene().rig) {
    throw std::runtime_error(played.paths.empty() ? "was saved without a schedule"
                                                  : "was saved under a schedule");
  }
  const std::string difference =
      difference_until(*model.scene().rig, *schedule, played, seen_until(model, state));
  if (!difference.empty())
    throw std::runtime_error("was saved under another schedule: in the one given, " + difference);
}

/// @throws std::runtime_error with the reason, as the rest of a sentence about the file.
State state_from(std::string_view bytes, const Model& model, const Schedule* schedule) {
  if (!bytes.starts_with(kMagic)) throw std::runtime_error("is not a saved state");
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < 2 * kWord || bytes.size() % kWord != 0) throw std::runtime_error("is cut");
  const std::string_view body = bytes.substr(0, bytes.size() - kWord);
  if (Reader(bytes.substr(body.size())).word() != checksum(body))
    throw std::runtime_error("is damaged: its checksum does not fit");
  Reader reader(body);
  if (reader.word() != fingerprint(model))
    throw std::runtime_error("was saved for another case, mesh or fidelity");
  Schedule played;
  State state;
  pass(reader, played);
  pass(reader, state);
  if (!reader.at_end()) throw std::runtime_error("is longer than a state");
  check_schedule(model, state, played, schedule);
  return state;
}

}  // namespace

void save_state(const std::filesystem::path& path, const Model& model, const State& state,
                const Schedule* schedule) {
  const Schedule played =
      schedule != nullptr ? played_until(*schedule, seen_until(model, state)) : Schedule();
  Writer writer;
  writer.word(fingerprint(model));
  pass(writer, played);
  pass(writer, state);
  const std::uint64_t sum = checksum(writer.bytes());
  writer.word(sum);
  std::filesystem::path beside = path;  // a name that no other process uses
  beside += fmt::format(".part-{}", ::getpid());
  std::error_code error;
  {
    std::ofstream file(beside, std::ios::binary);
    file << kMagic << writer.bytes();
    file.close();
    if (!file) error = std::error_code(errno, std::generic_category());
  }
  if (!error) std::filesystem::rename(beside, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  throw NotFinished(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

StateReading load_state(const std::filesystem::path& path, const Model& model, const Schedule* schedule) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) return {std::nullopt, path.string() + ": cannot be read"};
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  try {
    return {state_from(bytes, model, schedule), {}};
  } catch (const std::runtime_error& reason) {
    return {std::nullopt, fmt::format("{}: {}", path.string(), reason.what())};
  }
}

}  // namespace drapeplan
