// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Planar pose graphs in the text format of g2o:
//
//   VERTEX_SE2 id x y theta
//   EDGE_SE2 from to dx dy dtheta I11 I12 I13 I22 I23 I33
//   FIX id [id ...]
//
// Metres and radians; the information matrix is that of the error z^-1 (from^-1 to),
// in the frame of `to`, its upper triangle row by row. Comment lines start with '#'. Files compressed by
// gzip, xz or bzip2 are read transparently.
//
// Also read: VERTEX2 and EDGE2 of iSAM, with the same fields, and of TORO (often
// .graph), whose EDGE2 has its information as I11 I12 I22 I33 I13 I23. The
// order in which all matrices of the file are positive definite is taken; if
// both are, that of g2o. EDGE_SE2_SWITCHABLE and EDGE_SE2_MAXMIX of Vertigo are
// EDGE_SE2 with one more number behind the ids, which is not used.
//
// Two variants in public data sets are accepted as well: a file without any
// vertex (its vertices are the ends of the edges), and elements other than poses
// and what joins two of them (planar landmarks, sensor offsets, priors of single
// poses, switches), which are counted and skipped.
#ifndef CARTOGRAPHER_EXT_IO_G2O_H_
#define CARTOGRAPHER_EXT_IO_G2O_H_

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {

struct G2oEdge {
  int64_t from = 0;
  int64_t to = 0;
  Pose2 measurement;  // (from <- to)
  // In the frame of `to`: 1/m^2, 1/(m rad), 1/rad^2.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  int64_t line = 0;  // where it was read, from 1; 0 if it was not
};

struct G2oGraph {
  std::map<int64_t, Pose2> vertices;  // (world <- vertex) by id
  std::vector<G2oEdge> edges;         // in the order of the file
  std::set<int64_t> fixed;            // ids of fixed poses
  // The file had no vertex: the poses of `vertices` are all zero.
  bool lacks_vertices = false;
  std::map<std::string, int64_t> skipped;  // lines by element
};

// Reads a graph. Errors name file and line: malformed or unknown lines, numbers
// that are not finite, duplicate ids, edges or FIX of missing vertices, edges
// from a vertex to itself, information that is not positive definite. Several
// edges between the same vertices are fine. Elements of other dimensions
// (VERTEX_SE3:QUAT, ...) are errors that name them.
absl::StatusOr<G2oGraph> ReadG2o(const std::string& filename);

// Writes vertices by id, then FIX, then edges in their order, with all digits
// that a double needs; atomically.
absl::Status WriteG2o(const G2oGraph& graph, const std::string& filename);

// Poses by id from a ground truth file: a g2o graph (its vertices), edges only
// (chained from the origin along consecutive ids), or plain lines "x y theta"
// numbered from 0.
absl::StatusOr<std::map<int64_t, Pose2>> ReadPosesById(
    const std::string& filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_G2O_H_
