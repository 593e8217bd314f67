// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Separation of true and false loop candidates by their scores. Every matched
// candidate is labelled by ground truth, as in loop_statistics.h; each score
// then gives a curve of rates over its thresholds.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_LABELLED_LOOPS_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_LABELLED_LOOPS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_decision.pb.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"

namespace cartographer_ext {
namespace evaluation {

struct LabelledLoop {
  proto::LoopDecision decision;
  LoopVerdict label = LoopVerdict::kUnknown;
  double translation_error = 0.;  // metres, against truth
  double rotation_error = 0.;     // radians
};

// `graph` with the matched candidates of `decisions` in place of its loops, in
// their order, for the loop statistics. `candidates` gets the decision of each
// loop. Candidates whose submap or node the graph does not have are skipped.
MapGraph CandidateGraph(const MapGraph& graph,
                        const std::vector<proto::LoopDecision>& decisions,
                        std::vector<proto::LoopDecision>* candidates);

// `statistics` are those of a graph by `CandidateGraph`.
std::vector<LabelledLoop> LabelLoops(
    const std::vector<proto::LoopDecision>& candidates,
    const LoopStatistics& statistics);

// A score and whether the candidate is true.
struct ScoredLabel {
  double score = 0.;
  bool is_true = false;
};

// Rates at one threshold: candidates with at least this score count as
// accepted.
struct RatePoint {
  double threshold = 0.;
  double true_positive_rate = 0.;  // recall
  double false_positive_rate = 0.;
  double precision = 1.;
};

// One point for each distinct score, from strict to lenient.
std::vector<RatePoint> RateCurve(std::vector<ScoredLabel> labels);

// Area under the ROC curve: the probability that a true candidate scores more
// than a false one, ties counting half. Absent without both kinds.
absl::optional<double> AreaUnderCurve(std::vector<ScoredLabel> labels);

// Labelled candidates with the score that `kind` names; those without it are
// skipped.
enum class ScoreKind { kGrid, kTemporal, kFused, kProbability };
std::vector<ScoredLabel> Scores(const std::vector<LabelledLoop>& loops,
                                ScoreKind kind);

// Candidates whose score lies in a tenth of [0, 1].
struct ReliabilityBin {
  int64_t count = 0;
  double mean_score = 0.;
  double true_share = 0.;  // equal to the mean if scores are probabilities
};

// The reliability diagram: ten bins, the score 1 in the last one.
std::array<ReliabilityBin, 10> ReliabilityDiagram(
    const std::vector<ScoredLabel>& labels);

// Mean of |mean_score - true_share| over the candidates; absent without any.
absl::optional<double> ExpectedCalibrationError(
    const std::array<ReliabilityBin, 10>& bins);

struct ChainRates {
  int64_t true_candidates = 0;
  int64_t false_candidates = 0;
  int64_t true_accepted = 0;
  int64_t false_accepted = 0;
  absl::optional<double> precision() const;
  // Of the true candidates that the search found.
  absl::optional<double> recall() const;
};
ChainRates RatesOfChain(const std::vector<LabelledLoop>& loops);

// The labels as CSV with a header line: candidate, label, errors, and the
// columns of the decision log.
std::string LabelledCsv(const std::vector<LabelledLoop>& loops);

// ROC and precision-recall curves of the scores and the point of the whole chain,
// and the reliability diagram of the probability, side by side, as SVG.
std::string CurvesSvg(const std::vector<LabelledLoop>& loops,
                      const std::string& title);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_LABELLED_LOOPS_H_
