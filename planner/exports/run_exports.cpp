#include "planner/exports/run_exports.hpp"

#include "planner/drape/result_fields.hpp"
#include "planner/exports/fibres.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {

NamedFiles write_exports(const std::filesystem::path& folder, const std::string& name, const Case& definition,
                         const RunFrames& run, const RunResult& result) {
  NamedFiles files = write_frames(folder, name, run);
  const auto list = [&files](const NamedFiles& more) { files.insert(files.end(), more.begin(), more.end()); };
  if (definition.mold) list(write_surroundings(folder, *definition.mold, run.mapping));
  if (result.summary.status != RunStatus::diverged)
    list(write_fibres(folder, *run.scene, result.final, definition.name, hex(case_hash(definition))));
  return files;
}

}  // namespace drapeplan
