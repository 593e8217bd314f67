// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How the report looks, on a screen, light or dark, and on paper. The colours
// of data are those of Okabe and Ito, distinguishable by colour-blind readers, too;
// where a colour means good or bad, the line is solid or dashed as well.
#ifndef CARTOGRAPHER_EXT_REPORT_STYLE_H_
#define CARTOGRAPHER_EXT_REPORT_STYLE_H_

namespace cartographer_ext {
namespace report {

const char* StyleSheet();

// Moves the dividing line of the picture comparison; without it the two pictures
// are side by side.
const char* Script();

// Makes the figures of maps answer: moving and zooming by mouse, touch and keys,
// layers by their legend, a slider of time, and the evidence of a loop at a
// click. Without it they are pictures with hover texts.
const char* ViewerScript();

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_STYLE_H_
