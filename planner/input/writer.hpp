// Echoes the fields of a case as JSON, all defaults included.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "planner/input/field.hpp"

namespace drapeplan {

class FieldWriter : public FieldVisitor {
 public:
  [[nodiscard]] nlohmann::json& result() { return stack_.front(); }

  void field(const Field& field) override;
  bool section(const Section& section, bool present, const std::function<void()>& visit) override;
  void alternative(const std::string& selector, const std::string& word, bool selected,
                   const std::function<void()>& visit) override;
  void list(const ObjectList& list) override;
  void named(const NamedObjects& objects) override;

 private:
  /// What `visit` writes, as an object of its own.
  nlohmann::json object(const std::function<void()>& visit);
  /// Whether all sections are written that these fields need; without them nothing would read the fields.
  [[nodiscard]] bool useful(const std::vector<std::string>& needs) const;

  std::vector<nlohmann::json> stack_{nlohmann::json::object()};
};

}  // namespace drapeplan
