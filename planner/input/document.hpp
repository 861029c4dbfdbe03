// An input file as one JSON value, with the files that it refers to put in place and its overrides applied,
// and for every value the place where it was written.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "planner/input/error.hpp"

namespace drapeplan {

/// Keys of a case's root whose value may be the name of a JSON file instead of an object, relative to the
/// case file.
const std::vector<std::string>& keys_that_may_name_files();

class InputDocument {
 public:
  /// @param overrides  `path=value` as in read_case; JSON null as value takes the key away.
  /// @param keys       keys of the root whose value may name a file.
  explicit InputDocument(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                         const std::vector<std::string>& keys = {});

  /// A document that no file holds.
  explicit InputDocument(nlohmann::json root, const std::vector<std::string>& overrides = {});

  [[nodiscard]] const nlohmann::json& root() const { return root_; }
  /// Faults of files, texts and overrides.
  [[nodiscard]] const std::vector<InputError>& errors() const { return errors_; }
  /// Whether a file should stand at `pointer` that could not be read; then errors() says so.
  [[nodiscard]] bool unread(const std::string& pointer) const { return unread_.contains(pointer); }
  /// An error about the value at `pointer` of the whole document, placed in the file where that value stands
  /// (or, if it is missing, the value around it).
  [[nodiscard]] InputError error_at(const std::string& pointer, std::string message) const;
  /// The file that the value at `pointer` of the whole document names: relative to the file in which the value is
  /// written, or, if an override holds it, to the document's own.
  [[nodiscard]] std::filesystem::path file_at(const std::string& pointer, const std::string& name) const;
  /// Sorts errors into the order of the files and lines, overrides last.
  void sort(std::vector<InputError>& errors) const;

 private:
  /// A part of the document that was written in one place.
  struct Source {
    std::string prefix;  ///< pointer of that part in the whole document
    std::string file;    ///< or the text of the override
    std::map<std::string, int> lines;
    bool override_text = false;
  };

  void complete(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
                const std::vector<std::string>& keys);
  bool load(const std::filesystem::path& file, const std::string& prefix, nlohmann::json& into);
  void place_file(const std::filesystem::path& folder, const std::string& key);
  void apply(const std::string& override_text);
  [[nodiscard]] const Source& source_of(const std::string& pointer) const;

  nlohmann::json root_;
  std::vector<Source> sources_;
  std::vector<InputError> errors_;
  std::set<std::string> unread_;
};

}  // namespace drapeplan
