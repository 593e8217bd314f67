// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/report.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/front_end/match_record.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/report/loop_evidence.h"
#include "cartographer_ext/report/map_runs.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;
using testing::Not;

// A report of the room, with stock and ours run again.
class ReportTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pbstream_ = new io::Pbstream(
        test::MakeRoomMap(testing::TempDir() + "/report_test.pbstream"));
    graph_ = new evaluation::MapGraph(evaluation::MakeMapGraph(*pbstream_));
    contents_ = new evaluation::MapContents(
        evaluation::ReadMapContents(*pbstream_, {}));
    odometry_ = new std::map<int, evaluation::Trajectory>(
        evaluation::ReadOdometry(*pbstream_));
    truth_ = new evaluation::GroundTruth;
    std::vector<evaluation::StampedPose> poses;
    for (int i = 0; i < 520; ++i) {
      poses.push_back(io::MakeStampedPose(
          test::RoomSource::kStart + i * test::RoomSource::kStep,
          test::RoomSource::TruePose(i)));
    }
    truth_->reference = evaluation::Trajectory(poses);
    data_ = new ReportData;
    data_->title = "room <1>";
    data_->command_line = "evaluate -x \"a&b\"";
    data_->versions = Versions();
    data_->contents = contents_;
    data_->with_times = false;
    const RunInputs inputs = Inputs();
    evaluation::MapToEvaluate map;
    map.graph = graph_;
    map.contents = contents_;
    map.odometry = odometry_;
    const auto stored =
        evaluation::EvaluateMap(map, *truth_, inputs.evaluation);
    ASSERT_TRUE(stored.ok()) << stored.status();
    data_->runs.push_back(StoredRun(inputs, *stored));
    evaluation::RerunConfiguration configuration;
    configuration.stock_name = configuration.ours_name = "room.lua";
    configuration.stock =
        test::RoomConfiguration().map_builder_options.pose_graph_options();
    configuration.ours =
        test::RoomConfiguration("include \"loop_closure_default.lua\"")
            .map_builder_options.pose_graph_options();
    const absl::Status status = AddReruns(inputs, configuration, data_);
    ASSERT_TRUE(status.ok()) << status;
  }
  static void TearDownTestSuite() {
    delete data_;
    delete truth_;
    delete odometry_;
    delete contents_;
    delete graph_;
    delete pbstream_;
  }

  static RunInputs Inputs() {
    RunInputs inputs;
    inputs.pbstream = pbstream_;
    inputs.graph = graph_;
    inputs.contents = contents_;
    inputs.odometry = odometry_;
    inputs.truth = truth_;
    return inputs;
  }

  static io::Pbstream* pbstream_;
  static evaluation::MapGraph* graph_;
  static evaluation::MapContents* contents_;
  static std::map<int, evaluation::Trajectory>* odometry_;
  static evaluation::GroundTruth* truth_;
  static ReportData* data_;
};

io::Pbstream* ReportTest::pbstream_ = nullptr;
evaluation::MapGraph* ReportTest::graph_ = nullptr;
evaluation::MapContents* ReportTest::contents_ = nullptr;
std::map<int, evaluation::Trajectory>* ReportTest::odometry_ = nullptr;
evaluation::GroundTruth* ReportTest::truth_ = nullptr;
ReportData* ReportTest::data_ = nullptr;

size_t Count(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

TEST_F(ReportTest, TellsEverythingInOneFile) {
  const auto page = MakeReport(*data_);
  ASSERT_TRUE(page.ok()) << page.status();
  EXPECT_LT(page->size(), 5u << 20);
  EXPECT_THAT(*page, HasSubstr("room &lt;1&gt;"));
  EXPECT_THAT(*page, HasSubstr("evaluate -x &quot;a&amp;b&quot;"));
  EXPECT_THAT(*page, HasSubstr("Map sound"));
  for (const char* const id :
       {"map", "loops", "comparison", "scores", "path", "worst", "origin"}) {
    EXPECT_THAT(*page, HasSubstr(absl::StrCat("<h2 id=\"", id, "\"")));
  }
  EXPECT_THAT(*page, HasSubstr("id=\"map0\""));
  EXPECT_THAT(*page, HasSubstr("id=\"map2\""));
  EXPECT_THAT(*page, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(*page, HasSubstr("cartographer_ext: absent"));
  // Nothing is fetched.
  EXPECT_EQ(Count(*page, "http"), 0u);
  EXPECT_EQ(Count(*page, "src="), 0u);
  EXPECT_THAT(*page, Not(HasSubstr("nan\"")));
  EXPECT_THAT(*page, Not(HasSubstr("inf\"")));
  EXPECT_EQ(Count(*page, "<svg"), Count(*page, "</svg>"));
  EXPECT_EQ(Count(*page, "<figure"), Count(*page, "</figure>"));
}

TEST_F(ReportTest, SameInputSameBytes) {
  const auto first = MakeReport(*data_);
  const auto second = MakeReport(*data_);
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(*first, *second);
  EXPECT_THAT(*first, Not(HasSubstr("<h2 id=\"timing\"")));
  ReportData timed = *data_;
  timed.with_times = true;
  EXPECT_THAT(*MakeReport(timed), HasSubstr("<h2 id=\"timing\""));
}

TEST_F(ReportTest, NumbersForPrograms) {
  const auto json = RunsToJson(*data_);
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["name"], "as stored");
  EXPECT_EQ(json[0]["loops"], graph_->num_loops());
  EXPECT_GT(json[1]["against_stored"]["fraction_of_stored"], 0.95);
  EXPECT_GT(json[1]["evaluation"]["loops"]["precision"], 0.95);
  EXPECT_FALSE(json[1]["run"].contains("cpu_seconds"));
  EXPECT_GT(json[2]["run"]["decisions"].size(), 0u);
  const std::string csv = LoopsToCsv(*data_);
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 2 * graph_->num_loops());
  EXPECT_THAT(csv, HasSubstr("as stored,0,"));
}

TEST_F(ReportTest, DegeneracyAlongThePath) {
  const std::string filename = testing::TempDir() + "/room.matches";
  std::string bytes;
  for (const auto& node : pbstream_->nodes) {
    proto::MatchRecord record;
    record.set_time(node.node_data().timestamp());
    record.set_is_node(true);
    record.set_information_ratio(0.5);
    if (node.node_id().node_index() % 50 < 10) {
      record.set_degeneracy(proto::MatchRecord::TRANSLATION);
    }
    front_end::AppendRecord(record, &bytes);
  }
  std::ofstream(filename, std::ios::binary) << bytes;
  const auto samples = ReadDegeneracy(filename);
  ASSERT_TRUE(samples.ok()) << samples.status();
  EXPECT_EQ(samples->size(), pbstream_->nodes.size());
  EXPECT_EQ((*samples)[3].time, graph_->nodes.at({0, 3}).time);
  EXPECT_TRUE((*samples)[3].degenerate);
  EXPECT_FALSE((*samples)[12].degenerate);
  ReportData data = *data_;
  data.degeneracy = *samples;
  EXPECT_THAT(*MakeReport(data), HasSubstr("Degeneracy along the path"));

  std::ofstream(filename, std::ios::binary) << bytes.substr(0, 20) << "\xff";
  EXPECT_FALSE(ReadDegeneracy(filename).ok());
  EXPECT_FALSE(ReadDegeneracy("/nowhere/x.matches").ok());
}

TEST_F(ReportTest, EvidenceOfRefusedCandidates) {
  ReportRun run = data_->runs[2];
  run.rerun->decisions.clear();
  proto::LoopDecision decision;
  decision.set_submap_index(1);
  decision.set_node_index(77);
  decision.set_verdict(proto::LoopDecision::REJECTED);
  decision.set_reason(proto::LoopDecision::CONTRADICTED);
  decision.mutable_search()->set_grid_score(0.625);
  decision.mutable_search()->mutable_refined()->set_x(3.);
  decision.mutable_temporal()->set_score(0.5);
  run.rerun->decisions.push_back(decision);
  const auto evidence = CollectEvidence(run, *contents_);
  ASSERT_EQ(evidence.size(), static_cast<size_t>(run.graph.num_loops()) + 1);
  EXPECT_FALSE(evidence.back().accepted);
  EXPECT_EQ(evidence.back().relative_pose.x, 3.);
  const std::string text = Describe(evidence.back());
  EXPECT_THAT(text, HasSubstr("submap (0, 1) - node (0, 77), rejected"));
  EXPECT_THAT(text, HasSubstr("score on the grid 0.625"));
  EXPECT_THAT(text, HasSubstr("temporal score 0.500"));
  EXPECT_THAT(text, HasSubstr("contradicted"));
  EXPECT_THAT(Describe(evidence.front()), HasSubstr("truth: right"));
}

TEST(ReportErrorTest, NothingToReport) {
  EXPECT_FALSE(MakeReport(ReportData()).ok());
  ReportData empty;
  empty.runs.emplace_back();
  EXPECT_FALSE(MakeReport(empty).ok());
}

// Runs chromium over a page; false if there is none. `text`: what it prints.
bool OpenInBrowser(const std::string& name, const std::string& page,
                   const std::string& flags, std::string* const text) {
  const std::string stem = absl::StrCat(testing::TempDir(), "/", name);
  std::ofstream(stem + ".html") << page;
  const int status = std::system(
      absl::StrCat("timeout 120 chromium --headless=new --no-sandbox "
                   "--disable-gpu --hide-scrollbars --user-data-dir=",
                   stem, "_profile --enable-logging=stderr ", flags, " file://",
                   stem, ".html > ", stem, ".out 2> ", stem, ".log")
          .c_str());
  for (const char* const ending : {".out", ".log"}) {
    std::ifstream file(stem + ending);
    text->append(std::istreambuf_iterator<char>(file),
                 std::istreambuf_iterator<char>());
  }
  return status == 0;
}

TEST_F(ReportTest, OpensInABrowserWithoutErrors) {
  const std::string picture = testing::TempDir() + "/report_test.png";
  const std::string paper = testing::TempDir() + "/report_test.pdf";
  std::string text;
  if (!OpenInBrowser("report_test", *MakeReport(*data_),
                     "--window-size=1366,2000 --screenshot=" + picture,
                     &text) ||
      !OpenInBrowser("report_test", *MakeReport(*data_),
                     "--print-to-pdf=" + paper, &text)) {
    GTEST_SKIP() << "no chromium here";
  }
  EXPECT_THAT(text, Not(HasSubstr("CONSOLE")));
  for (const std::string& filename : {picture, paper}) {
    std::ifstream drawn(filename, std::ios::binary | std::ios::ate);
    EXPECT_GT(drawn.tellg(), 20000) << filename;
  }
}

// Does what a user does, and writes what has changed as JSON into the page.
constexpr char kUser[] = R"html(<script>
window.addEventListener('load', function() {
var out = {};
function box(svg) { return svg.getAttribute('viewBox').split(' ').map(
function(v) { return (+v).toFixed(2); }).join(' '); }
var svg = document.querySelector('svg.map-figure'), home = box(svg);
var frame = svg.parentNode, r = svg.getBoundingClientRect();
function key(name) {
svg.dispatchEvent(new KeyboardEvent('keydown', {key: name})); return box(svg); }
function pointer(type, id, x, y) {
svg.dispatchEvent(new PointerEvent(type, {pointerId: id, clientX: r.left + x,
clientY: r.top + y})); }
function click(e) { e.dispatchEvent(new MouseEvent('click', {bubbles: true})); }
function width() { return +box(svg).split(' ')[2]; }
var label = svg.querySelector('.ring-label');
function fontSize() { return parseFloat(getComputedStyle(label).fontSize); }
var font = fontSize();
out.plus = key('+') !== home;
out.labelKeepsItsSize = Math.abs(fontSize() / font -
width() / +home.split(' ')[2]) < .01;
var before = box(svg);
out.arrow = key('ArrowLeft') !== before;
out.all = key('0') === home;
var wheel = {deltaY: -300, clientX: r.left + 50, clientY: r.top + 50,
cancelable: true};
svg.dispatchEvent(new WheelEvent('wheel', wheel));
out.wheelScrollsThePage = box(svg) === home;
wheel.ctrlKey = true;
svg.dispatchEvent(new WheelEvent('wheel', wheel));
out.wheel = width() < +home.split(' ')[2];
before = box(svg);
pointer('pointerdown', 1, 100, 100); pointer('pointermove', 1, 130, 120);
pointer('pointerup', 1, 130, 120);
out.drag = box(svg) !== before;
before = width();
pointer('pointerdown', 1, 100, 100); pointer('pointerdown', 2, 150, 100);
pointer('pointermove', 2, 250, 100);
pointer('pointerup', 1, 100, 100); pointer('pointerup', 2, 250, 100);
out.pinch = width() < before;
frame.querySelectorAll('.tools button').forEach(click);
out.button = box(svg) === home;
var entry = frame.nextElementSibling.querySelector('button');
click(entry);
out.layer = entry.getAttribute('aria-pressed') === 'false' &&
svg.querySelectorAll('.by-time.off').length > 0;
var slider = frame.querySelector('.time input');
slider.value = 0; slider.dispatchEvent(new Event('input'));
out.time = svg.querySelectorAll('.timed[style*=hidden]').length > 0;
var panel = frame.querySelector('.evidence'), ring = svg.querySelector('.ring');
pointer('pointerdown', 3, 1, 1); pointer('pointerup', 3, 1, 1);
click(ring);
out.ring = panel.textContent; out.ringScans = svg.querySelectorAll('.scan').length;
click(document.querySelector('.verdict .show'));
out.reason = box(svg) !== home;
var loop = document.querySelector('.loop[data-loop]');
var loops = loop.closest('.viewer');
click(loop);
out.loop = loops.querySelector('.evidence').textContent;
out.loopScans = loops.querySelectorAll('.scan').length;
out.fits = document.documentElement.scrollWidth <= window.innerWidth;
out.dark = getComputedStyle(document.body).backgroundColor;
var answers = document.createElement('pre');
answers.textContent = 'ANSWERS' + JSON.stringify(out) + 'ANSWERS';
document.body.appendChild(answers); });
</script>)html";

TEST_F(ReportTest, AnswersMouseTouchAndKeys) {
  ReportData data = *data_;
  auto& consistency = *data.runs[0].evaluation.consistency;
  evaluation::PathPiece piece;
  piece.first_node = {0, 30};
  piece.last_node = {0, 40};
  piece.submaps = {{0, 0}};
  consistency.places = {piece};
  consistency.word = "broken";
  consistency.reasons.push_back("nodes (0, 30) to (0, 40) (1.0 s) contradict");
  data.runs[0].evaluation.trajectory.reset();
  const std::string page = absl::StrCat(*MakeReport(data), kUser);
  std::string text;
  if (!OpenInBrowser("report_test_user", page,
                     "--window-size=500,900 --dump-dom "
                     "--blink-settings=preferredColorScheme=0",
                     &text)) {
    GTEST_SKIP() << "no chromium here";
  }
  EXPECT_THAT(text, Not(HasSubstr("CONSOLE")));
  const std::vector<std::string> parts = absl::StrSplit(text, "ANSWERS");
  const auto end = std::find_if(
      parts.rbegin(), parts.rend(),
      [](const std::string& part) { return part.rfind("{\"plus\"", 0) == 0; });
  ASSERT_TRUE(end != parts.rend()) << text.substr(text.size() - 2000);
  const auto answers = nlohmann::json::parse(*end, nullptr, false);
  ASSERT_TRUE(answers.is_object()) << *end;
  for (const auto& answer : answers.items()) {
    if (!answer.value().is_boolean()) continue;
    EXPECT_TRUE(answer.value().get<bool>()) << answer.key();
  }
  EXPECT_THAT(answers["ring"], HasSubstr("of the contradicted submap"));
  EXPECT_EQ(answers["ringScans"], 2);
  EXPECT_THAT(answers["loop"], HasSubstr("Remove: -drop_loops 0:"));
  EXPECT_EQ(answers["loopScans"], 2);
  EXPECT_EQ(answers["dark"], "rgb(20, 24, 28)");
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
