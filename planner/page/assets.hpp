// Style, markup and scripts of the page, as texts: the files of this folder, put into the program by CMake.
#pragma once

namespace drapeplan {

/// page.css
extern const char* const kPageStyle;
/// view.html: the place of the view in space, with its controls.
extern const char* const kViewSection;
/// draw.js, view.js and controls.js, in this order, as one script.
extern const char* const kViewScript;

}  // namespace drapeplan
