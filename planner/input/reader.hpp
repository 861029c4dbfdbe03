// Reads fields from a document and collects everything that is wrong.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "planner/input/document.hpp"
#include "planner/input/field.hpp"

namespace drapeplan {

class FieldReader : public FieldVisitor {
 public:
  explicit FieldReader(const InputDocument& document);

  /// Reads all fields that `visit_root` states; faults go to errors().
  void read(const std::function<void(FieldVisitor&)>& visit_root);
  [[nodiscard]] std::vector<InputError>& errors() { return errors_; }
  /// Adds an error about the value at `pointer`; the value is shown if there is one.
  void fail(const std::string& pointer, const std::string& message);
  /// The same without the value.
  void add_error(const std::string& pointer, std::string message);
  /// Adds errors of a file that the value at `pointer` names.
  void add_errors(const std::string& pointer, const std::vector<InputError>& errors);
  /// The file that the value at `pointer` names, see InputDocument.
  [[nodiscard]] std::filesystem::path file_at(const std::string& pointer, const std::string& name) const {
    return document_.file_at(pointer, name);
  }
  /// Whether the value at `pointer` is there and nothing at or below it is wrong.
  [[nodiscard]] bool good(const std::string& pointer) const;

  void field(const Field& field) override;
  bool section(const Section& section, bool present, const std::function<void()>& visit) override;
  void alternative(const std::string& selector, const std::string& word, bool selected,
                   const std::function<void()>& visit) override;
  void list(const ObjectList& list) override;
  void named(const NamedObjects& objects) override;

 private:
  /// The object whose fields are being read.
  struct Frame {
    const nlohmann::json* object = nullptr;
    std::string pointer;
    std::vector<std::string> known;  ///< names of all its fields
    std::map<std::string, std::string>
        elsewhere;                         ///< fields of an alternative that was not chosen -> which one
    std::set<std::string> failed_choices;  ///< wrong words: then nobody knows which alternative is meant
  };

  /// The value called `name` in the current object, or nullptr with an error if it is required.
  const nlohmann::json* find(const std::string& name, bool required, const std::string& doc);
  /// Visits the fields of `object`, then looks for keys that nobody asked for.
  void visit_object(const nlohmann::json& object, const std::string& pointer,
                    const std::function<void()>& visit);
  void check_keys(const Frame& frame);
  void check_needs(const std::string& name, const std::vector<std::string>& needs);

  const InputDocument& document_;
  std::vector<Frame> frames_;
  std::vector<InputError> errors_;
  std::vector<std::string> failed_;  ///< pointers of the errors, in the whole case
  bool skipping_ = false;            ///< inside an alternative that was not chosen: only names are noted
  std::string unchosen_;             ///< what would choose it; empty if that is not known
};

}  // namespace drapeplan
