#include "planner/batch/run_folders.hpp"

#include <fmt/format.h>

#include <map>

namespace drapeplan {

std::vector<std::filesystem::path> run_folders(const std::vector<std::string>& files,
                                               const std::string& out) {
  const std::filesystem::path root = out.empty() ? "out" : out;
  if (files.size() == 1 && !out.empty()) return {root};
  std::vector<std::filesystem::path> folders;
  for (const std::string& file : files) folders.push_back(root / std::filesystem::path(file).stem());
  return folders;
}

std::vector<InputError> shared_folders(const std::vector<std::string>& files,
                                       const std::vector<std::filesystem::path>& folders) {
  std::vector<InputError> errors;
  std::map<std::filesystem::path, std::string> owner;
  for (size_t k = 0; k < files.size(); ++k) {
    const auto [found, fresh] = owner.try_emplace(folders[k], files[k]);
    if (fresh) continue;
    errors.push_back({files[k], 0, "",
                      fmt::format("would be planned in the folder of {}, {}; plan them in two calls with "
                                  "different --out, or rename one",
                                  found->second, folders[k].string())});
  }
  return errors;
}

}  // namespace drapeplan
