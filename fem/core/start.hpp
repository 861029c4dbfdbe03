// Where a ply without a rig is when a run begins.
#pragma once

namespace drapeplan {

enum class Start {
  level,    ///< level at `start_height`
  on_mold,  ///< in the mold's tangent plane at `position`, its underside touching there
};

}  // namespace drapeplan
