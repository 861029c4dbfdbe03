// Drapes in space over time, as a part of the page that can be turned, played and coloured by a field.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/model/scene.hpp"
#include "planner/drape/map_result.hpp"

namespace drapeplan {

/// One drape; what it points to must outlive the call of `view_markup`.
struct ViewDrape {
  std::string name;                               ///< "wave"
  const Scene* scene = nullptr;                   ///< with the mesh and the rig, if there is one
  const std::vector<Snapshot>* frames = nullptr;  ///< by their times, those of one run
};

/// Equal bands of a value from zero up.
struct ViewScale {
  double step = 1;
  std::vector<std::string> colours;  ///< of the bands, "#rrggbb"
  int decimals = 0;                  ///< of the bands' limits
};

struct View {
  std::vector<ViewDrape> drapes;           ///< of one case: one mold, one rig; the last one is shown first
  const MapResult* mapping = nullptr;      ///< with the prescribed boundary and the net; null without one
  std::function<ViewScale(double)> scale;  ///< bands up to a largest value > 0
};

/// HTML of the view: ply, mold, grippers and interlinks at the time of a slider, coloured by the gap to the
/// mold, the shear angle, or the angle between the fibres and those of the mapped net; with script and data,
/// nothing is loaded from elsewhere. It is hidden without scripts, without WebGL 2, and in print.
///
/// Data, as JSON: `drapes` (each with its name, `times` [s], `quads` and `outline` of nodes, `rest` [m], and
/// of all frames, one after the other, `position`, `pads`, `joints` [m] and the `fields`), `fields` (name,
/// unit, bands of the scale), `mold` (a grid of points [m]), `boundary` [m], `links` (pairs of grippers),
/// `pad_radius` [m], `spacing` of the lines on the ply [m], and the `box` that is seen at first [m]. Long
/// lists are base64 of 16-bit numbers between limits. Frames are left out evenly where the text would be
/// longer than 6 MB.
/// @returns empty without a frame that has finite nodes.
std::string view_markup(const View& view);

}  // namespace drapeplan
