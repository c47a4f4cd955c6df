#include "softforce/report/live_page.h"

#include "report/page_style.h"
#include "report/run_data.h"
#include "report/scripts.h"

namespace softforce::report {
namespace {

constexpr char kHead[] = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>softforce</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="/page.css">
</head>
)";

constexpr char kBody[] = R"(<body>
<main class="live">
<header>
<div><h1 id="scene">softforce</h1><span id="link" class="verdict advice" role="status">connecting</span>
<span id="moment" class="soft"></span></div>
<form id="controls" class="tools">
<button type="button" data-post="tare">Tare</button>
<button type="button" data-post="record" id="record">Record</button>
<button type="button" data-post="pause" id="pause">Pause</button>
<button type="button" data-post="stop">Stop</button>
<input id="token" type="password" autocomplete="off" placeholder="token" aria-label="Token">
<span id="said" role="status"></span>
</form>
</header>
<p id="reason" class="box advice" hidden></p>
<div class="cards" id="cards"></div>
<figure><img id="picture" alt="Pictures of all cameras with the body drawn over them" hidden>
<figcaption id="picture-caption">No pictures as yet.</figcaption></figure>
<div class="row">
<figure><div class="tools"><b>Forces</b>
<select id="part" aria-label="Component"><option value="3">norm</option><option value="0">x</option>
<option value="1">y</option><option value="2">z</option></select>
<span id="force-key"></span></div>
<svg id="forces" viewBox="0 0 560 300" role="img" aria-label="Forces over time"></svg>
<figcaption>The last 60 s of the frames' time. Bands hold the force with 95 % probability.</figcaption>
</figure>
<figure><div id="view"></div><figcaption id="view-caption">No body as yet.</figcaption></figure>
</div>
<div class="row">
<figure><b>Markers</b> <span id="marker-key"></span><div id="markers"></div></figure>
<figure class="wide"><b>Stages</b><table id="stages"></table>
<figcaption>ms for each frame; stages work beside each other on different frames.</figcaption></figure>
</div>
</main>
<script src="/view.js"></script>
<script src="/page.js"></script>
</body>
</html>
)";

constexpr char kStyle[] = R"(
main.live { max-width: 1280px; padding-top: 14px; }
.live header { display: flex; flex-wrap: wrap; justify-content: space-between; gap: 4px 20px;
  position: sticky; top: 0; z-index: 5; background: var(--desk); padding: 6px 0 10px; }
.live h1 { display: inline; margin-right: 12px; font-size: 21px; }
.live #moment { margin-left: 8px; font-variant-numeric: tabular-nums; }
.live header .tools { margin-top: 0; }
.live button { padding: 7px 14px; font-weight: 600; }
.live button:disabled { opacity: .45; cursor: not-allowed; }
.live button.on { background: var(--bad); color: var(--bad-ink); }
.live #token { font: inherit; width: 9em; color: var(--ink); background: var(--paper);
  border: 1px solid var(--axis); border-radius: 6px; padding: 5px 8px; }
.live .cards { margin: 6px 0 12px; grid-template-columns: repeat(auto-fit, minmax(115px, 1fr)); }
.live .card b { font-variant-numeric: tabular-nums; }
.live #picture { display: block; width: 100%; border-radius: 4px; cursor: zoom-in; }
.live #picture.large { width: 200%; max-width: none; cursor: zoom-out; }
.live figure { overflow-x: auto; }
.live #markers { display: flex; flex-wrap: wrap; gap: 4px; margin-top: 8px; }
.live #markers span { min-width: 30px; padding: 1px 4px; text-align: center; border-radius: 4px;
  font-size: 12px; color: #1d2733; background: var(--hue); }
.live #markers .s2 { border: 2px dashed var(--paper); }
.live #markers .s3 { text-decoration: line-through; }
.live .stale { opacity: .5; }
@media (max-width: 640px) { main.live { padding: 8px 10px 40px; } .live header { position: static; }
  .live th, .live td { padding-right: 9px; } }
)";

}  // namespace

LivePageFiles MakeLivePage() {
  return {std::string(kHead) + kBody, std::string(kPageStyle) + kStyle, LivePageScript(),
          LiveViewScript()};
}

std::string LiveShape(const BodyShape& body, const std::vector<std::string>& marker_statuses) {
  RunRecord record;
  record.body = body;
  record.marker_statuses = marker_statuses;
  BodyView rest;
  rest.time_s = 0;
  rest.u = Eigen::Matrix3Xf::Zero(3, body.nodes.cols());
  record.views.push_back(rest);
  return BodyData(record);
}

std::string LiveView(const BodyView& view) { return OneView(view); }

}  // namespace softforce::report
