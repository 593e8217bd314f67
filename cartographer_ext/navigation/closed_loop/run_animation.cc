// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/run_animation.h"

#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "cartographer_ext/common/atomic_file.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace navigation {
namespace {

// The page; %TITLE% and %DATA% are replaced. Lengths in the data are
// centimetres in the map frame, which keeps them short.
constexpr char kPage[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>%TITLE%</title>
<style>
body{font:14px/1.4 system-ui,sans-serif;margin:12px;color:#222;background:#fff}
canvas{border:1px solid #ccc;max-width:100%;display:block}
#bar{display:flex;gap:10px;align-items:center;margin:8px 0;flex-wrap:wrap}
#seek{flex:1;min-width:200px} #state{min-height:3em;font-variant-numeric:tabular-nums}
i{display:inline-block;width:.8em;height:.8em;border-radius:50%;margin:0 .3em 0 .8em}
</style></head><body>
<h1 style="font-size:18px">%TITLE%</h1>
<canvas id="view"></canvas>
<div id="bar"><button id="play">Pause</button>
<label>speed <select id="speed"><option>1</option><option>2</option><option selected>5</option>
<option>10</option><option>20</option></select></label>
<input id="seek" type="range" min="0" value="0"><span id="clock"></span></div>
<div id="state"></div>
<div><i style="background:#0072b2"></i>robot (outline: where it believes to be)
<i style="background:#009e73"></i>planned path<i style="background:#56b4e9"></i>echoes
<i style="background:#d55e00"></i>put in its way<i style="background:#cc79a7"></i>people
<i style="background:#e69f00"></i>goals</div>
<script>
"use strict";
const run = %DATA%;
const canvas = document.getElementById("view"), draw = canvas.getContext("2d");
const map = run.map, scale = Math.max(1, Math.min(4, 1400 / map.width));
canvas.width = map.width * scale; canvas.height = map.height * scale;
const floor = document.createElement("canvas");
floor.width = map.width; floor.height = map.height;
(() => {  // the map: runs of unknown, free and occupied cells, from the top row
  const context = floor.getContext("2d"), image = context.createImageData(map.width, map.height);
  const grey = [205, 255, 0];
  let at = 0;
  for (let i = 0; i < map.runs.length; i += 2)
    for (let n = map.runs[i + 1]; n > 0; --n, ++at) {
      image.data.fill(grey[map.runs[i]], 4 * at, 4 * at + 3);
      image.data[4 * at + 3] = 255;
    }
  context.putImageData(image, 0, 0);
})();
const px = x => (x - map.x) / map.cell * scale;
const py = y => canvas.height - (y - map.y) / map.cell * scale;
const size = r => r / map.cell * scale;
function disc(x, y, r, style, fill) {
  draw.beginPath(); draw.arc(px(x), py(y), Math.max(1.5, size(r)), 0, 7);
  if (fill) { draw.fillStyle = style; draw.fill(); }
  else { draw.strokeStyle = style; draw.lineWidth = 2; draw.stroke(); }
}
function line(points, style, width) {
  draw.beginPath();
  for (let i = 0; i + 1 < points.length; i += 2) draw.lineTo(px(points[i]), py(points[i + 1]));
  draw.strokeStyle = style; draw.lineWidth = width; draw.stroke();
}
function robot(p, style, fill) {
  disc(p[0], p[1], run.radius, style, fill);
  line([p[0], p[1], p[0] + 1.6 * run.radius * Math.cos(p[2]), p[1] + 1.6 * run.radius * Math.sin(p[2])], style, 2);
}
let paths = [], last = [];
for (const frame of run.frames) { if (frame.l) last = frame.l; paths.push(last); }
function show(index) {
  const f = run.frames[index];
  draw.imageSmoothingEnabled = false;
  draw.drawImage(floor, 0, 0, canvas.width, canvas.height);
  line(run.frames.slice(0, index + 1).flatMap(g => [g.t[0], g.t[1]]), "rgba(0,114,178,.35)", 2);
  run.goals.forEach((g, i) => {
    disc(g[0], g[1], 15, i < f.g ? "#999" : "#e69f00", true);
    draw.fillStyle = "#000"; draw.font = "13px sans-serif"; draw.fillText(i + 1, px(g[0]) + 8, py(g[1]) - 8);
  });
  line(paths[index], "#009e73", 2);
  draw.fillStyle = "#56b4e9";
  for (let i = 0; i + 1 < f.e.length; i += 2) draw.fillRect(px(f.e[i]) - 1, py(f.e[i + 1]) - 1, 3, 3);
  for (const d of f.s) disc(d[0], d[1], d[2], "#d55e00", true);
  for (const d of f.m) disc(d[0], d[1], d[2], "#cc79a7", true);
  robot(f.t, "#0072b2", true); robot(f.p, "#000", false);
  document.getElementById("clock").textContent = f.c.toFixed(1) + " s";
  document.getElementById("state").textContent =
    run.states[f.q] + ": " + f.w + "   " + f.v[0].toFixed(2) + " m/s, " + f.v[1].toFixed(2) + " rad/s";
}
const seek = document.getElementById("seek"), play = document.getElementById("play");
seek.max = run.frames.length - 1;
let index = 0, playing = true, before = null, rest = 0;
function step(now) {
  if (playing && before !== null && run.frames.length > 1) {
    rest += (now - before) / 1000 * Number(document.getElementById("speed").value);
    while (rest >= run.interval && index < run.frames.length - 1) { rest -= run.interval; ++index; }
    if (index === run.frames.length - 1) { playing = false; play.textContent = "Again"; }
    seek.value = index;
  }
  before = now;
  if (run.frames.length) show(index);
  requestAnimationFrame(step);
}
play.onclick = () => {
  if (!playing && index === run.frames.length - 1) index = 0;
  playing = !playing; rest = 0; play.textContent = playing ? "Pause" : "Play";
};
seek.oninput = () => { index = Number(seek.value); };
const wanted = Number(new URLSearchParams(location.search).get("frame"));
if (wanted > 0) { index = Math.min(wanted, run.frames.length - 1); playing = false; play.textContent = "Play"; }
requestAnimationFrame(step);
</script></body></html>
)html";

int Centimetres(const double metres) {
  return static_cast<int>(std::lround(100. * metres));
}

nlohmann::ordered_json Flat(const std::vector<Eigen::Vector2d>& points) {
  nlohmann::ordered_json flat = nlohmann::ordered_json::array();
  for (const Eigen::Vector2d& point : points) {
    flat.push_back(Centimetres(point.x()));
    flat.push_back(Centimetres(point.y()));
  }
  return flat;
}

nlohmann::ordered_json DiscsJson(const std::vector<simulation::Disc>& discs) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const simulation::Disc& disc : discs) {
    json.push_back({Centimetres(disc.center.x()), Centimetres(disc.center.y()),
                    Centimetres(disc.radius)});
  }
  return json;
}

nlohmann::ordered_json PoseJson(const Pose2& pose) {
  return {Centimetres(pose.x), Centimetres(pose.y),
          std::round(1e3 * pose.theta) / 1e3};
}

// Runs of equal cells, the top row first: 0 unknown, 1 free, 2 occupied.
nlohmann::ordered_json MapJson(const io::OccupancyMap& map) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  int kind = -1;
  int64_t length = 0;
  for (int y = map.height - 1; y >= 0; --y) {
    for (int x = 0; x != map.width; ++x) {
      const float value = map.at(x, y);
      const int here = std::isnan(value) ? 0 : value < 0.5f ? 1 : 2;
      if (here != kind) {
        if (length > 0) {
          runs.push_back(kind);
          runs.push_back(length);
        }
        kind = here;
        length = 0;
      }
      ++length;
    }
  }
  runs.push_back(kind);
  runs.push_back(length);
  return {{"width", map.width},
          {"height", map.height},
          {"cell", 100. * map.resolution},
          {"x", 100. * map.origin.x},
          {"y", 100. * map.origin.y},
          {"runs", runs}};
}

nlohmann::ordered_json FrameJson(const NavigationFrame& frame,
                                 const NavigationFrame* const before) {
  nlohmann::ordered_json json;
  json["c"] = std::round(1e2 * frame.time) / 1e2;
  json["t"] = PoseJson(frame.true_pose);
  json["p"] = PoseJson(frame.pose);
  json["v"] = {std::round(1e3 * frame.velocity.linear) / 1e3,
               std::round(1e3 * frame.velocity.angular) / 1e3};
  json["q"] = static_cast<int>(frame.state);
  json["w"] = frame.message;
  json["g"] = frame.goal;
  json["s"] = DiscsJson(frame.stationary);
  json["m"] = DiscsJson(frame.moving);
  json["e"] = Flat(frame.echoes);
  // Only frames in which it changes.
  if (before == nullptr || before->path != frame.path) {
    json["l"] = Flat(frame.path);
  }
  return json;
}

std::string EscapeHtml(const std::string& text) {
  return absl::StrReplaceAll(
      text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

}  // namespace

absl::Status WriteRunAnimation(const NavigationRun& run,
                               const std::string& title,
                               const std::string& filename) {
  nlohmann::ordered_json data;
  data["map"] = MapJson(run.map);
  data["radius"] = Centimetres(run.robot_radius);
  data["interval"] = run.frame_seconds;
  data["goals"] = nlohmann::ordered_json::array();
  for (const GoalResult& goal : run.goals) {
    if (goal.goal.allFinite()) data["goals"].push_back(Flat({goal.goal}));
  }
  data["states"] = nlohmann::ordered_json::array();
  for (int state = 0; state <= static_cast<int>(DriveState::kFinished);
       ++state) {
    data["states"].push_back(ToString(static_cast<DriveState>(state)));
  }
  data["frames"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i != run.frames.size(); ++i) {
    data["frames"].push_back(
        FrameJson(run.frames[i], i == 0 ? nullptr : &run.frames[i - 1]));
  }
  // "</" would end the script.
  const std::string text = absl::StrReplaceAll(data.dump(), {{"</", "<\\/"}});
  return WriteFileAtomically(
      filename, absl::StrReplaceAll(
                    kPage, {{"%TITLE%", EscapeHtml(title)}, {"%DATA%", text}}));
}

}  // namespace navigation
}  // namespace cartographer_ext
