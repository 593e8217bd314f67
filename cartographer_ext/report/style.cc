// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/style.h"

namespace cartographer_ext {
namespace report {

namespace {

constexpr char kStyleSheet[] = R"css(
:root{color-scheme:light dark;--ground:#fff;--panel:#f6f7f8;--ink:#1c2126;
--soft:#5b646d;--rule:#d5dade;--blue:#0072b2;--sky:#56b4e9;--green:#009e73;
--orange:#c87f00;--red:#d55e00;--purple:#b0528a;--map-filter:none}
@media (prefers-color-scheme:dark){:root{--ground:#14181c;--panel:#1d2329;
--ink:#e6e9ec;--soft:#a3adb7;--rule:#3a434c;--blue:#4aa8e0;--sky:#7cc8f2;
--green:#2fc99c;--orange:#e69f00;--red:#ff8a3d;--purple:#d98ab8;
--map-filter:brightness(.82)}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:1180px;margin:0 auto;padding:24px 20px 64px}
h1{font-size:1.7rem;line-height:1.2;margin:0 0 4px;overflow-wrap:anywhere}
h2{font-size:1.25rem;margin:44px 0 8px;padding-top:10px;
border-top:1px solid var(--rule)}
h3{font-size:1rem;margin:20px 0 6px}
p{margin:6px 0 12px;max-width:78ch}
.soft,figcaption,caption{color:var(--soft);font-size:.9rem}
nav{display:flex;flex-wrap:wrap;gap:4px 16px;margin:14px 0;font-size:.9rem}
a{color:var(--blue)}
.verdict{display:flex;gap:16px;align-items:flex-start;background:var(--panel);
border-left:8px solid var(--soft);border-radius:6px;padding:14px 18px;
margin:16px 0}
.verdict.sound{border-color:var(--green)}
.verdict.doubtful{border-color:var(--orange)}
.verdict.broken{border-color:var(--red)}
.verdict .word{font-size:1.35rem;font-weight:700;white-space:nowrap}
.verdict.sound .word{color:var(--green)}
.verdict.doubtful .word{color:var(--orange)}
.verdict.broken .word{color:var(--red)}
.verdict ul{margin:2px 0;padding-left:20px}
.tiles{display:grid;gap:10px;
grid-template-columns:repeat(auto-fit,minmax(150px,1fr));margin:14px 0}
.tile{background:var(--panel);border-radius:6px;padding:10px 12px}
.tile b{display:block;font-size:1.25rem;font-variant-numeric:tabular-nums}
.tile span{color:var(--soft);font-size:.85rem}
figure{margin:14px 0;break-inside:avoid}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:16px}
.pair figure{margin:6px 0}
.grid3{display:grid;gap:14px;
grid-template-columns:repeat(auto-fill,minmax(310px,1fr))}
svg{display:block;width:100%;height:auto}
svg.store{position:absolute;width:0;height:0}
svg.map-figure{max-height:86vh;border:1px solid var(--rule);border-radius:4px}
.unknown{fill:#dddddd;filter:var(--map-filter)}
.map{filter:var(--map-filter);image-rendering:auto}
.path,.line{fill:none;stroke-width:1.6;stroke-linejoin:round;
vector-effect:non-scaling-stroke}
.path{stroke-width:2}
.by-time{stroke:var(--when)}
.swatch.by-time{border-image:linear-gradient(90deg,hsl(205 75% 45%),
hsl(325 75% 45%)) 1}
.loop{stroke-width:1.3;vector-effect:non-scaling-stroke;stroke-linecap:round}
.loop:hover,.ring:hover{stroke-width:5}
.loop.bad{stroke-dasharray:7 4;stroke-width:1.8}
.dots{fill:none;stroke-width:3;stroke-linecap:round;
vector-effect:non-scaling-stroke}
.s1{stroke:#0072b2;--c:#0072b2}.s2{stroke:#d55e00;--c:#d55e00}
.s3{stroke:#009e73;--c:#009e73}.s4{stroke:#a3487b;--c:#a3487b}
.s5{stroke:#56b4e9;--c:#56b4e9}.s6{stroke:#e69f00;--c:#e69f00}
.s7{stroke:#777;--c:#777}
.faint{stroke-opacity:.45}.thin{stroke-width:1}
.chart .line{stroke-width:1.5}.chart .s1{stroke:var(--blue)}
.chart .s2{stroke:var(--red)}.chart .s3{stroke:var(--green)}
.chart .s4{stroke:var(--purple)}.chart .s5{stroke:var(--sky)}
.chart .s6{stroke:var(--orange)}
.dot{stroke:none;fill:var(--c);fill-opacity:.75}
.dot:hover{fill-opacity:1;stroke:var(--ink);stroke-width:1.5}
.bar,.key{fill:var(--c);stroke:none}.bar{fill-opacity:.72}
.bar:hover{fill-opacity:1}.band{stroke:none;fill:var(--c);fill-opacity:.2}
.chart{background:var(--panel);border-radius:6px}
.grid{stroke:var(--rule);stroke-width:1}.axis{stroke:var(--soft)}
.mark{stroke:var(--ink);stroke-width:1.2;stroke-dasharray:5 4}
.chart text{fill:var(--soft);font-size:12px}
.chart .label,.chart .mark-label{fill:var(--ink)}
.middle{text-anchor:middle}.end{text-anchor:end}
.ring{fill:#d55e00;fill-opacity:.1;stroke:#d55e00;stroke-width:2.5;
vector-effect:non-scaling-stroke}
.ring-label{font-size:calc(24px*var(--zoom,1));font-weight:700;fill:#8a3300;
stroke:#fff;stroke-width:calc(4px*var(--zoom,1));paint-order:stroke}
.scale{fill:none;stroke:#222;stroke-width:2;vector-effect:non-scaling-stroke}
.scale-label{font-size:20px;fill:#222;stroke:#fff;stroke-width:4;
paint-order:stroke}
.legend{display:flex;flex-wrap:wrap;gap:4px 18px;font-size:.88rem;
margin:6px 0;color:var(--soft)}
.entry{display:inline-flex;align-items:center;gap:6px}
.swatch{width:20px;height:0;border-top:3px solid var(--c)}
.swatch.bad{border-top-style:dashed}
.compare{position:relative}
.compare .top{position:absolute;inset:0;
clip-path:inset(0 calc(100% - var(--split,50%)) 0 0)}
.compare .rule{position:absolute;top:0;bottom:0;left:var(--split,50%);width:2px;
margin-left:-1px;background:#d55e00;pointer-events:none}
.slider{display:flex;gap:12px;align-items:center;font-size:.9rem}
.slider input{flex:1;accent-color:var(--blue)}
.scroll{overflow-x:auto;margin:10px 0}
table{border-collapse:collapse;font-size:.9rem;min-width:50%}
caption{text-align:left;padding:2px 0 6px}
th,td{padding:3px 12px 3px 0;border-bottom:1px solid var(--rule);
text-align:left;vertical-align:top}
thead th{font-weight:600;color:var(--soft)}
tbody th{font-weight:400}
.number{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
pre{background:var(--panel);border-radius:6px;padding:10px 12px;overflow:auto;
font-size:.85rem;white-space:pre-wrap;overflow-wrap:anywhere}
.print-only{display:none}
.viewer{position:relative}.viewer svg{cursor:grab}
.viewer svg:focus-visible{outline:2px solid var(--blue)}
.viewer.zoomed svg{touch-action:none}
.tools{position:absolute;right:8px;top:8px;display:flex;gap:4px;z-index:1}
.tools button,.evidence button{font:inherit;min-width:2.2em;padding:2px 8px;
background:var(--ground);color:var(--ink);border:1px solid var(--rule);
border-radius:4px;cursor:pointer}
.viewer .loop{cursor:pointer;pointer-events:stroke}
.viewer .loop.chosen{stroke-width:6;stroke-opacity:1}
.viewer .ring{cursor:pointer}.viewer .ring.chosen{fill-opacity:0}
.show{font:inherit;font-size:.85rem;margin-left:8px;padding:0 6px;
background:var(--ground);color:var(--blue);border:1px solid var(--rule);
border-radius:4px;cursor:pointer}
button.entry{all:unset;display:inline-flex;align-items:center;gap:6px;
cursor:pointer}button.entry:focus-visible{outline:2px solid var(--blue)}
button.entry[aria-pressed=false]{opacity:.4;text-decoration:line-through}
.off{display:none}
.scan{fill:none;stroke-width:3;stroke-linecap:round;
vector-effect:non-scaling-stroke;pointer-events:none}
.scan.loop-scan{stroke:#0072b2}.scan.map-scan{stroke:#e05000}
.evidence{background:var(--panel);border-radius:6px;padding:10px 14px;
margin:8px 0;white-space:pre-wrap}
.evidence code{user-select:all}
@media print{.tools,.evidence,.time,.show{display:none}}
@media (max-width:720px){.pair{grid-template-columns:1fr}}
@media print{:root{color-scheme:light;--ground:#fff;--panel:#f4f4f4;--ink:#000;
--soft:#444;--rule:#bbb;--map-filter:none}body{font-size:10.5pt}
main{max-width:none;padding:0}nav,.screen-only{display:none}
.print-only{display:block}.pair.print-only{display:grid}
h2{margin-top:22px}h2,h3,h2+p{break-after:avoid}
tr,.scroll,pre,.verdict,.tiles{break-inside:avoid}
.verdict{font-size:9.5pt}.tiles{grid-template-columns:repeat(6,1fr)}
.scroll{overflow:visible}
table{font-size:8.5pt}th,td{padding:2px 7px 2px 0}.number{white-space:normal}
.soft,figcaption,.legend{font-size:8.5pt;line-height:1.35}
.grid3{grid-template-columns:repeat(3,1fr);gap:8px}
.grid3 svg.map-figure{height:6.5cm}
svg.map-figure{max-height:9.3cm}#map+figure svg.map-figure{max-height:17cm}}
)css";

constexpr char kScript[] = R"js(
document.querySelectorAll('.slider input').forEach(function(input){
var box=document.getElementById(input.dataset.target);
function move(){box.style.setProperty('--split',input.value+'%');}
input.addEventListener('input',move);move();});
)js";

}  // namespace

const char* StyleSheet() { return kStyleSheet; }

const char* Script() { return kScript; }

}  // namespace report
}  // namespace cartographer_ext
