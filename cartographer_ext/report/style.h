// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The style of the report, on screen, light or dark, and in print. The colours
// of data are those of Okabe and Ito, distinguishable by colour-blind readers,
// too; where a colour means good or bad, the line is solid or dashed as well.
#ifndef CARTOGRAPHER_EXT_REPORT_STYLE_H_
#define CARTOGRAPHER_EXT_REPORT_STYLE_H_

namespace cartographer_ext {
namespace report {

const char* StyleSheet();

// Script of the movable divider of the picture comparison; without it the two
// pictures are side by side.
const char* Script();

// Script of the interactive map figures: panning and zooming by mouse, touch
// and keys, layers by their legend, a time slider, and the evidence of a loop
// on click. Without it they are static with tooltips.
const char* ViewerScript();

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_STYLE_H_
