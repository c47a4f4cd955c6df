#include "report/page_style.h"

namespace softforce::report {

// The hues are those of Okabe and Ito, told apart with every common colour vision deficiency; the
// paler of them are darkened to stand on white, and all lightened to stand on black. s0 … s3 are
// the markers' statuses, in the colours of the overlay.
const char* const kPageStyle = R"(
:root { color-scheme: light dark; --ink: #1d2733; --soft: #5d6b7a; --line: #d9dfe6; --paper: #fff;
  --desk: #f3f5f8; --plot: #fcfdfe; --axis: #8795a4; --alarm: #c62828;
  --hue0: #0072b2; --hue1: #c85400; --hue2: #008f68; --hue3: #a64d84; --hue4: #94700a;
  --hue5: #4d5c6b; --seen: #009e73; --one: #f0e442; --hidden: #cc79a7; --rejected: #d55e00;
  --nothing: #fbe6e4; --good: #d9f2e1; --good-ink: #12592c; --warn: #fdecc8; --warn-ink: #6b4300;
  --bad: #fbd9d7; --bad-ink: #7d1512; }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e4e9ef; --soft: #9dabb9; --line: #333d48; --paper: #1a2028; --desk: #11151a;
    --plot: #1d242d; --axis: #6c7a89; --alarm: #ff8a80;
    --hue0: #56b4e9; --hue1: #ff9a52; --hue2: #3ccfa4; --hue3: #e39cc8; --hue4: #f0c74c;
    --hue5: #aebac6; --nothing: #4a2c2e; --good: #17422a; --good-ink: #a9e5be;
    --warn: #4d3a10; --warn-ink: #f6d78f; --bad: #55201e; --bad-ink: #ffb9b4; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--desk); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1020px; margin: 0 auto; padding: 24px 20px 60px; }
h1 { font-size: 24px; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 34px 0 6px; }
h3 { font-size: 15px; margin: 12px 0 4px; }
p { margin: 4px 0 10px; max-width: 80ch; }
.soft, figcaption { color: var(--soft); }
.verdict { display: inline-block; padding: 2px 12px; border-radius: 12px; font-weight: 600; }
.good { background: var(--good); color: var(--good-ink); }
.advice { background: var(--warn); color: var(--warn-ink); }
.bad { background: var(--bad); color: var(--bad-ink); }
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
.facts td { white-space: normal; overflow-wrap: anywhere; vertical-align: top; }
summary { cursor: pointer; color: var(--soft); }
.key { display: inline-block; width: 11px; height: 11px; border-radius: 3px; margin: 0 4px 0 12px; }
.entry { white-space: nowrap; }
text { font: 12px system-ui, "Segoe UI", Arial, sans-serif; fill: var(--soft); }
text.number { font-size: 10.5px; font-weight: 600; }
text.light { fill: #fff; } text.dark { fill: #1d2733; }
.c0, .cz { --hue: var(--hue0); } .c1, .cx { --hue: var(--hue1); } .c2, .cy { --hue: var(--hue2); }
.c3 { --hue: var(--hue3); } .c4 { --hue: var(--hue4); } .c5 { --hue: var(--hue5); }
.s0 { --hue: var(--seen); } .s1 { --hue: var(--one); } .s2 { --hue: var(--hidden); }
.s3 { --hue: var(--rejected); }
.key { background: var(--hue); }
.grid { stroke: var(--line); } .axis { stroke: var(--axis); }
.frame { fill: none; stroke: var(--axis); } .paper { fill: var(--plot); }
.empty { fill: var(--nothing); stroke: var(--line); } .cell { stroke: var(--paper); }
.dots { stroke: var(--hue); stroke-width: 2.4; stroke-linecap: round; opacity: .45; }
.arrows { stroke: var(--hue); stroke-width: 1; fill: none; }
.arrows.large { stroke: var(--alarm); } .arrows.outlier { stroke: var(--alarm); stroke-width: 1.4; }
.scale { stroke: var(--ink); stroke-width: 2.5; }
.bar { fill: var(--hue); } .bar:hover, .spot:hover { opacity: .6; }
.out { fill: var(--paper); stroke: var(--hue); stroke-dasharray: 2 2; }
.level { stroke: var(--hue); stroke-dasharray: 6 4; }
.spot { fill: var(--hue); opacity: .75; }
.line { fill: none; stroke: var(--hue); stroke-width: 1.6; stroke-linejoin: round;
  stroke-linecap: round; }
.band { fill: var(--hue); opacity: .2; }
.whisker { stroke: var(--hue); stroke-width: 2; }
.status { fill: var(--hue); }
.board { fill: #2468b2; fill-opacity: .07; stroke: #7f9cbd; stroke-width: .8; }
.camera { fill: var(--hue); fill-opacity: .35; stroke: var(--hue); }
.cursor { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 3 3; pointer-events: none; }
.hover { touch-action: pan-y; }
#tip { position: fixed; z-index: 9; pointer-events: none; display: none; max-width: 360px;
  background: var(--paper); color: var(--ink); border: 1px solid var(--axis); border-radius: 6px;
  padding: 6px 10px; font-size: 13px; line-height: 1.45; box-shadow: 0 2px 10px #0004;
  font-variant-numeric: tabular-nums; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); gap: 14px; align-items: start; }
.pictures img { display: block; width: 100%; border-radius: 4px; cursor: zoom-in; }
.pictures .wide { grid-column: 1 / -1; } .pictures .wide img { cursor: zoom-out; }
#view { position: relative; }
#view canvas { display: block; width: 100%; aspect-ratio: 16 / 9; border-radius: 4px;
  touch-action: none; cursor: grab; }
#view canvas:active { cursor: grabbing; }
.tools { display: flex; flex-wrap: wrap; align-items: center; gap: 8px 14px; margin-top: 10px;
  font-size: 13px; color: var(--soft); }
.tools label { display: inline-flex; align-items: center; gap: 5px; white-space: nowrap; }
.tools input[type=range] { accent-color: var(--hue0); }
.tools .time { flex: 1 1 240px; min-width: 160px; }
button, select { font: inherit; color: var(--ink); background: var(--desk);
  border: 1px solid var(--line); border-radius: 6px; padding: 3px 10px; cursor: pointer; }
button:hover { border-color: var(--axis); }
.labels { position: absolute; inset: 0 0 auto 0; aspect-ratio: 16 / 9; overflow: hidden;
  pointer-events: none; font-size: 12px; font-weight: 600; }
.labels span { position: absolute; transform: translate(-50%, -50%); white-space: nowrap;
  padding: 0 4px; border-radius: 4px; background: color-mix(in srgb, var(--paper) 78%, transparent); }
.moment { min-width: 170px; }
.ramp { position: absolute; left: 26px; top: 26px; display: flex; gap: 8px; pointer-events: none;
  font-size: 12px; color: var(--soft); }
.ramp i { width: 12px; height: 150px; border-radius: 3px; }
.ramp div { display: flex; flex-direction: column; justify-content: space-between; }
@media (max-width: 640px) { .row { grid-template-columns: 1fr; } }
@media print { :root { color-scheme: light; } body { background: #fff; } main { max-width: none; }
  figure, .card, .box { break-inside: avoid; } h2 { break-after: avoid; }
  .tools, #tip { display: none !important; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)";

}  // namespace softforce::report
