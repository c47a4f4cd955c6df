#include "report/page_style.h"

namespace softforce::report {

const char* const kPageStyle = R"(
:root { --ink: #1d2733; --soft: #5d6b7a; --line: #d9dfe6; --paper: #fff; }
* { box-sizing: border-box; }
body { margin: 0; background: #f3f5f8; color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1020px; margin: 0 auto; padding: 24px 20px 60px; }
h1 { font-size: 24px; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 34px 0 6px; }
h3 { font-size: 15px; margin: 12px 0 4px; }
p { margin: 4px 0 10px; max-width: 80ch; }
.soft, figcaption { color: var(--soft); }
.verdict { display: inline-block; padding: 2px 12px; border-radius: 12px; font-weight: 600; }
.good { background: #d9f2e1; color: #12592c; }
.advice { background: #fdecc8; color: #6b4300; }
.bad { background: #fbd9d7; color: #7d1512; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px;
  margin: 16px 0; }
.card, figure, .box { background: var(--paper); border: 1px solid var(--line); border-radius: 8px; }
.card { padding: 10px 14px; }
.card b { display: block; font-size: 21px; font-weight: 600; }
.card span { color: var(--soft); font-size: 13px; }
.box { padding: 10px 16px; overflow-x: auto; }
.box ul { margin: 4px 0; padding-left: 20px; }
.box li { margin: 6px 0; }
.row { display: grid; align-items: start; grid-template-columns: repeat(auto-fit, minmax(380px, 1fr)); gap: 14px; }
figure { margin: 0 0 14px; padding: 12px; }
figcaption { font-size: 13px; margin-top: 4px; }
svg { display: block; width: 100%; height: auto; margin: 0 auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--soft); }
th, td { padding: 2px 18px 2px 0; border-bottom: 1px solid var(--line); white-space: nowrap; }
td.number, th.number { text-align: right; }
summary { cursor: pointer; color: var(--soft); }
.key { display: inline-block; width: 11px; height: 11px; border-radius: 3px; margin: 0 4px 0 12px; }
text { font: 12px system-ui, "Segoe UI", Arial, sans-serif; fill: var(--soft); }
text.number { font-size: 10.5px; font-weight: 600; }
text.light { fill: #fff; } text.dark { fill: #1d2733; }
.c0 { --camera: #2468b2; } .c1 { --camera: #d9730d; } .c2 { --camera: #23875a; }
.c3 { --camera: #8e44ad; } .c4 { --camera: #b03060; } .c5 { --camera: #4d5c6b; }
.key.c0, .key.c1, .key.c2, .key.c3, .key.c4, .key.c5 { background: var(--camera); }
.grid { stroke: var(--line); } .axis { stroke: #8795a4; }
.frame { fill: none; stroke: #8795a4; } .paper { fill: #fcfdfe; }
.empty { fill: #fbe6e4; stroke: #f2c9c5; } .cell { stroke: #fff; }
.dots { stroke: var(--camera); stroke-width: 2.4; stroke-linecap: round; opacity: .45; }
.arrows { stroke: var(--camera); stroke-width: 1; fill: none; }
.arrows.large { stroke: #c62828; } .arrows.outlier { stroke: #c62828; stroke-width: 1.4; }
.scale { stroke: var(--ink); stroke-width: 2.5; }
.bar { fill: var(--camera); } .bar:hover, .spot:hover { opacity: .6; }
.out { fill: #fff; stroke: var(--camera); stroke-dasharray: 2 2; }
.level { stroke: var(--camera); stroke-dasharray: 6 4; }
.spot { fill: var(--camera); opacity: .75; }
.board { fill: #2468b2; fill-opacity: .07; stroke: #7f9cbd; stroke-width: .8; }
.camera { fill: var(--camera); fill-opacity: .35; stroke: var(--camera); }
@media print { body { background: #fff; } figure, .card { break-inside: avoid; } }
)";

}  // namespace softforce::report
