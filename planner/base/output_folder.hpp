// Places that results go to: tried before any work, owned by one run at a time, nothing of others replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

/// The file of a results folder that a run locks; it names the verb that made the results, and the process.
inline constexpr const char* kRunLock = "run.lock";

/// The verb whose results a folder holds, by its run.lock; empty if it has none of ours.
std::string verb_of_results(const std::filesystem::path& folder);

/// The folder of one run's results. While the object lives, no other run can own the folder: run.lock is
/// locked, and the system lifts the lock of a process that ends, in whatever way. The file stays, and says
/// from then on whose results the folder holds. Use: make the object, check all input, `begin()`, work,
/// write.
class OutputFolder {
 public:
  /// No folder: nothing is to be written.
  OutputFolder() = default;

  /// Makes the folder if it is absent, locks it, and tries that files can be made in it. What it holds stays
  /// as it is.
  /// @param verb  whose results it will hold, e.g. "plan".
  /// @param log   a log that this run may go on with, e.g. "evaluations.jsonl": a folder without run.lock
  /// that holds
  ///              results is accepted if it holds this file.
  /// @throws WrongInput  if the folder cannot be made or written into, another run works in it, or it holds
  /// results
  ///                     of another verb, or results of which nothing says that a run of ours made them.
  OutputFolder(const std::filesystem::path& folder, const std::string& verb, const std::string& log = "");

  /// A folder in which nothing was begun is left as it was found: what was made for it is removed.
  ~OutputFolder();
  OutputFolder(OutputFolder&& other) noexcept { swap(other); }
  OutputFolder& operator=(OutputFolder&& other) noexcept {
    swap(other);
    return *this;
  }

  explicit operator bool() const { return lock_ >= 0; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

  /// Moves the results of an earlier run into a new folder below this one, earlier-1, earlier-2 and so on, so
  /// that files of two runs never lie side by side. Other files stay. To be called before the first file is
  /// written.
  /// @param kept  files that this run goes on with, or replaces; they stay.
  /// @return the folder that was made for them; empty if there were none.
  /// @throws NotFinished if something cannot be moved.
  std::filesystem::path begin(const std::vector<std::string>& kept = {});

 private:
  void make_folder();
  void open_lock();
  [[nodiscard]] bool lock_lies_in_folder() const;
  void refuse_foreign(const std::string& verb, const std::string& log) const;
  void swap(OutputFolder& other) noexcept;

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // folders, the outermost first
  int lock_ = -1;                            // file descriptor
  bool lock_is_new_ = false;
  bool begun_ = false;
};

/// Whether a file of this name in a results folder is a result of ours, half-written ones included.
bool is_result_name(std::string_view name);

/// Tries a single file that will be written at the end of a run.
/// @param begins  how files of this kind begin. @param kind  what they are called, e.g. "a saved state".
/// @throws WrongInput  unless `file` is absent or a regular file that begins so, and its folder takes new
/// files.
void try_output_file(const std::filesystem::path& file, std::string_view begins, const std::string& kind);

}  // namespace drapeplan
