#include "planner/base/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "drapeplan ";  // how run.lock begins; the verb follows
constexpr std::string_view kEarlier = "earlier-";
constexpr size_t kLongestLock = 4096;  // bytes; a longer file is none of ours

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// The first bytes of an open file, at most kLongestLock; empty if it cannot be read.
std::string first_bytes(int file) {
  std::string text(kLongestLock, '\0');
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  text.resize(count > 0 ? size_t(count) : 0);
  return text;
}

/// The verb in the text of a run.lock; empty if there is none.
std::string verb_of(const std::string& lock) {
  if (!lock.starts_with(kMark)) return "";
  return lock.substr(kMark.size(), lock.find('\n') - kMark.size());
}

std::string lock_text(const std::string& verb) {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("{}{}\nprocess {} on {}\n", kMark, verb, ::getpid(), host.data());
}

/// The number N of a name "earlier-N"; 0 for all other names.
int earlier_number(std::string_view name) {
  if (!name.starts_with(kEarlier)) return 0;
  name.remove_prefix(kEarlier.size());
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : 0;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) throw WrongInput(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::string verb_of_results(const fs::path& folder) {
  const int file =
      ::open((folder / kRunLock).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return "";
  const std::string lock = first_bytes(file);
  ::close(file);
  return verb_of(lock);
}

bool is_result_name(std::string_view name) {
  static constexpr std::array kNames{"result.json",
                                     "resolved.json",
                                     "evaluations.jsonl",
                                     "schedule.json",
                                     "schedule_uniform.json",
                                     "schedule_wave.json",
                                     "schedule.csv",
                                     "schedule.csv-metadata.json",
                                     "schedule_wide.csv",
                                     "schedule_ros2.yaml",
                                     "report.html",
                                     "study.md",
                                     "study.jsonl",
                                     "points.csv",
                                     "ranks.csv",
                                     "bench.csv",
                                     "stress.csv",
                                     "stress.md",
                                     "validate.md",
                                     "validation.html",
                                     "material.json",
                                     "characterisation.html",
                                     "net.csv",
                                     "pattern.dxf",
                                     "fibres.csv",
                                     "fibres.csv-metadata.json",
                                     "probes.csv",
                                     "grips.csv",
                                     "design.json"};
  static constexpr std::array kEndings{".vtu", ".pvd", ".svg"};
  constexpr std::string_view kPartial = ".partial";
  if (name.ends_with(kPartial)) name.remove_suffix(kPartial.size());
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         (name.starts_with("profile_") && name.ends_with(".csv")) ||
         std::any_of(kEndings.begin(), kEndings.end(), [&](const char* end) { return name.ends_with(end); });
}

// The other constructor has made the object: where this one throws, the destructor takes back what was done.
OutputFolder::OutputFolder(const fs::path& folder, const std::string& verb, const std::string& log)
    : OutputFolder() {
  folder_ = folder;
  make_folder();
  open_lock();
  refuse_foreign(verb, log);
  if (::faccessat(AT_FDCWD, folder_.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    throw WrongInput(fmt::format("{}: no file can be made in it: {}", folder_.string(), reason(errno)));
  const std::string text = lock_text(verb);  // written before the rest is cut off: it is never empty
  if (::pwrite(lock_, text.data(), text.size(), 0) != ssize_t(text.size()) ||
      ::ftruncate(lock_, off_t(text.size())) != 0)
    throw WrongInput(fmt::format("{}: cannot be written into: {}", folder_.string(), reason(errno)));
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) {
    if (!begun_ && lock_is_new_) ::unlink((folder_ / kRunLock).c_str());
    ::close(lock_);
  }
  if (begun_) return;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) ::rmdir(folder->c_str());  // if empty
}

void OutputFolder::swap(OutputFolder& other) noexcept {
  folder_.swap(other.folder_);
  made_.swap(other.made_);
  std::swap(lock_, other.lock_);
  std::swap(lock_is_new_, other.lock_is_new_);
  std::swap(begun_, other.begun_);
}

/// Makes the folder and those above it that are absent.
void OutputFolder::make_folder() {
  std::vector<fs::path> absent;
  std::error_code error;
  for (fs::path folder = folder_; !folder.empty(); folder = folder.parent_path()) {
    if (fs::status(folder, error).type() != fs::file_type::not_found) break;
    if (folder.has_filename()) absent.push_back(folder);  // none: the path ends with a slash
  }
  for (auto folder = absent.rbegin(); folder != absent.rend(); ++folder) {
    if (::mkdir(folder->c_str(), 0777) == 0) {
      made_.push_back(*folder);
    } else if (errno != EEXIST) {
      throw WrongInput(fmt::format("{}: cannot be made: {}", folder->string(), reason(errno)));
    }
  }
  const fs::file_status status = fs::status(folder_, error);
  if (fs::is_directory(status)) return;
  const bool exists = fs::exists(status) && !error;
  throw WrongInput(
      fmt::format("{}: {}", folder_.string(),
                  exists ? "is no folder; results need one" : "cannot be made: " + error.message()));
}

/// Opens run.lock, or makes it, and locks it.
void OutputFolder::open_lock() {
  const fs::path file = folder_ / kRunLock;
  constexpr int kFlags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY;
  constexpr int kMostTries = 1000;
  for (int tries = 0; tries < kMostTries; ++tries) {
    lock_ = ::open(file.c_str(), kFlags);
    lock_is_new_ = lock_ < 0 && errno == ENOENT;
    if (lock_is_new_) lock_ = ::open(file.c_str(), kFlags | O_CREAT | O_EXCL, 0666);
    if (lock_ < 0 && errno == EEXIST) continue;  // another process was faster
    if (lock_ < 0)
      throw WrongInput(fmt::format("{}: cannot be written into: {}", folder_.string(), reason(errno)));
    struct stat status {};
    if (::fstat(lock_, &status) != 0 || !S_ISREG(status.st_mode))
      throw WrongInput(fmt::format("{}: is no file of a run, and is left as it is", file.string()));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      lock_is_new_ = false;  // whoever owns it takes care of it
      if (error != EWOULDBLOCK)
        throw WrongInput(fmt::format("{}: cannot be locked: {}", file.string(), reason(error)));
      std::string owner = first_bytes(lock_);
      std::replace(owner.begin(), owner.end(), '\n', ' ');
      throw WrongInput(fmt::format(
          "{}: another run works in this folder{}; wait for its end or choose another one", folder_.string(),
          owner.empty() ? "" : fmt::format(" ({})", owner.substr(0, owner.size() - 1))));
    }
    if (lock_lies_in_folder()) return;
    ::close(lock_);  // its owner has removed it meanwhile
    lock_ = -1;
  }
  throw WrongInput(
      fmt::format("{}: cannot be locked: others make and remove it all the time", file.string()));
}

bool OutputFolder::lock_lies_in_folder() const {
  struct stat mine {
  }, there{};
  return ::fstat(lock_, &mine) == 0 && ::lstat((folder_ / kRunLock).c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

void OutputFolder::refuse_foreign(const std::string& verb, const std::string& log) const {
  const std::string lock = first_bytes(lock_), owner = verb_of(lock);
  if (!lock.empty() && owner.empty())
    throw WrongInput(
        fmt::format("{}: is no file of a run, and is left as it is", (folder_ / kRunLock).string()));
  if (!owner.empty() && owner != verb)
    throw WrongInput(
        fmt::format("{}: holds results of `{}`, which `{}` does not replace; choose another folder",
                    folder_.string(), owner, verb));
  if (!owner.empty()) return;
  const std::vector<std::string> names = names_in(folder_);
  if (!log.empty() && std::find(names.begin(), names.end(), log) != names.end()) return;
  for (const std::string& name : names) {
    if (!is_result_name(name)) continue;
    throw WrongInput(fmt::format("{}: holds {}, and no {} that says which run made it; choose another folder",
                                 folder_.string(), name, kRunLock));
  }
}

fs::path OutputFolder::begin(const std::vector<std::string>& kept) {
  begun_ = true;
  if (!*this) return {};
  std::vector<std::string> left;
  int last = 0;
  for (const std::string& name : names_in(folder_)) {
    last = std::max(last, earlier_number(name));
    if (is_result_name(name) && std::find(kept.begin(), kept.end(), name) == kept.end()) left.push_back(name);
  }
  if (left.empty()) return {};
  fs::path earlier = folder_ / fmt::format("{}{}", kEarlier, last + 1);
  std::error_code error;
  fs::create_directory(earlier, error);
  for (const std::string& name : left) {
    if (!error) fs::rename(folder_ / name, earlier / name, error);
  }
  if (error)
    throw NotFinished(fmt::format("{}: what an earlier run left cannot be moved to {}: {}", folder_.string(),
                                  earlier.string(), error.message()));
  return earlier;
}

void try_output_file(const fs::path& file, std::string_view begins, const std::string& kind) {
  struct stat status {};
  const bool exists = ::lstat(file.c_str(), &status) == 0;
  if (!exists && errno != ENOENT)
    throw WrongInput(fmt::format("{}: cannot be written: {}", file.string(), reason(errno)));
  if (exists && !S_ISREG(status.st_mode))
    throw WrongInput(fmt::format("{}: is no regular file, and is left as it is", file.string()));
  if (exists) {
    const int old = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    const std::string first = old < 0 ? "" : first_bytes(old);
    if (old >= 0) ::close(old);
    if (!first.starts_with(begins))
      throw WrongInput(
          fmt::format("{}: is not {}, and is left as it is; choose another name", file.string(), kind));
  }
  const fs::path trial = fmt::format("{}.part-{}", file.string(), ::getpid());
  const int made = ::open(trial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (made < 0) throw WrongInput(fmt::format("{}: cannot be written: {}", file.string(), reason(errno)));
  ::close(made);
  ::unlink(trial.c_str());
}

}  // namespace drapeplan
