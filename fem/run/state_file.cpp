#include "fem/run/state_file.hpp"

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
#include "mapping/error.hpp"

// Layout: the line kMagic, then 64-bit words, lowest byte first: the model's fingerprint, the state, and at
// the end the FNV-1a hash of all words before. Lists have their length before them.
namespace drapeplan {
namespace {

constexpr std::string_view kMagic = "drapeplan state 3\n";
constexpr size_t kWord = 8;  // bytes

/// States every part of a state to `visit`, which reads or writes it.
template <class StateType, class Visit>
void visit_state(StateType& s, const Visit& visit) {
  visit(s.step);
  for (auto* value : {&s.time, &s.dt, &s.dt_before, &s.stable_dt}) visit(*value);
  for (auto* field :
       {&s.position, &s.velocity, &s.director, &s.director_rate, &s.anchor, &s.edges[0], &s.edges[1]}) {
    for (auto* part : {&field->x, &field->y, &field->z}) visit(*part);
  }
  visit(s.stuck);
  visit(s.history);
  visit(s.pads);
  visit(s.lightness);
  for (auto& value : s.work) visit(value);
  auto& r = s.record;
  for (auto* value : {&r.fibre_strain, &r.fibre_compression, &r.actuator_force, &r.link_error, &r.penetration,
                      &r.energy, &r.balance, &r.hourglass_share, &r.kinetic_ratio, &r.last_motion}) {
    visit(*value);
  }
}

template <class Pad, class Visit>
void visit_pad(Pad& pad, const Visit& visit) {
  for (int k = 0; k < 3; ++k) visit(pad.centre[k]);
  for (int k = 0; k < 4; ++k) visit(pad.rotation.coeffs()[k]);
  for (int k = 0; k < 3; ++k) visit(pad.velocity[k]);
  for (int k = 0; k < 3; ++k) visit(pad.angular_velocity[k]);
  double released = pad.released ? 1 : 0;
  visit(released);
  if constexpr (!std::is_const_v<Pad>) pad.released = released != 0;
}

class Writer {
 public:
  void word(std::uint64_t bits) {
    for (size_t byte = 0; byte < kWord; ++byte) bytes_.push_back(char((bits >> (8 * byte)) & 0xff));
  }
  void operator()(double value) { word(std::bit_cast<std::uint64_t>(value)); }
  void operator()(std::int64_t value) { word(std::uint64_t(value)); }
  void operator()(const std::vector<double>& list) {
    word(list.size());
    for (const double value : list) (*this)(value);
  }
  void operator()(const std::vector<PadState>& pads) {
    word(pads.size());
    for (const PadState& pad : pads) visit_pad(pad, [this](double value) { (*this)(value); });
  }
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
  void operator()(double& value) { value = std::bit_cast<double>(word()); }
  void operator()(std::int64_t& value) { value = std::int64_t(word()); }
  void operator()(std::vector<double>& list) {
    list.resize(length());
    for (double& value : list) (*this)(value);
  }
  void operator()(std::vector<PadState>& pads) {
    pads.resize(length());
    for (PadState& pad : pads) visit_pad(pad, [this](double& value) { (*this)(value); });
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  size_t length() {
    const std::uint64_t count = word();
    if (count > bytes_.size() / kWord) throw std::runtime_error("has a list longer than itself");
    return size_t(count);
  }
  std::string_view bytes_;
  size_t at_ = 0;
};

std::uint64_t checksum(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes);
  return hash.value();
}

/// @throws std::runtime_error with the reason, as the rest of a sentence about the file.
State state_from(std::string_view bytes, const Model& model) {
  if (!bytes.starts_with(kMagic)) throw std::runtime_error("is not a saved state");
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < 2 * kWord || bytes.size() % kWord != 0) throw std::runtime_error("is cut");
  const std::string_view body = bytes.substr(0, bytes.size() - kWord);
  if (Reader(bytes.substr(body.size())).word() != checksum(body))
    throw std::runtime_error("is damaged: its checksum does not fit");
  Reader reader(body);
  if (reader.word() != model.fingerprint())
    throw std::runtime_error("was saved for another case, mesh or fidelity");
  State state;
  visit_state(state, [&reader](auto& part) { reader(part); });
  if (!reader.at_end()) throw std::runtime_error("is longer than a state");
  return state;
}

}  // namespace

void save_state(const std::filesystem::path& path, const Model& model, const State& state) {
  Writer writer;
  writer.word(model.fingerprint());
  visit_state(state, [&writer](const auto& part) { writer(part); });
  const std::uint64_t sum = checksum(writer.bytes());
  writer.word(sum);
  std::filesystem::path beside = path;  // a name that no other process uses
  beside += ".part-" + std::to_string(::getpid());
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
  throw NotFinished(path.string() + ": cannot be written: " + error.message());
}

StateReading load_state(const std::filesystem::path& path, const Model& model) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) return {std::nullopt, path.string() + ": cannot be read"};
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  try {
    return {state_from(bytes, model), {}};
  } catch (const std::runtime_error& reason) {
    return {std::nullopt, path.string() + ": " + reason.what()};
  }
}

}  // namespace drapeplan
