#include "softforce/pipeline/overlay_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

struct Layer {
  const char* name;
  bool OverlayLayers::*on;
};

constexpr std::array<Layer, 10> kLayers{{{"net", &OverlayLayers::net},
                                         {"stress", &OverlayLayers::stress},
                                         {"displacement", &OverlayLayers::displacement},
                                         {"markers", &OverlayLayers::markers},
                                         {"regions", &OverlayLayers::regions},
                                         {"candidates", &OverlayLayers::candidates},
                                         {"forces", &OverlayLayers::forces},
                                         {"cables", &OverlayLayers::cables},
                                         {"axes", &OverlayLayers::axes},
                                         {"chart", &OverlayLayers::chart}}};

OverlayLayers Every(bool on) {
  OverlayLayers layers;
  for (const Layer& layer : kLayers) layers.*layer.on = on;
  layers.stress = false;  // the body has one colour at a time
  return layers;
}

}  // namespace

std::string OverlayLayerNames() {
  std::string names;
  for (const Layer& layer : kLayers) names += (names.empty() ? "" : ",") + std::string(layer.name);
  return names;
}

OverlayLayers ParseOverlayLayers(const std::string& text, const std::string& option) {
  if (text == "all" || text == "none") return Every(text == "all");
  const bool left_out = !text.empty() && text[0] == '-';
  OverlayLayers layers = Every(left_out);
  std::istringstream names(text);
  std::string name;
  do {
    name.clear();
    std::getline(names, name, ',');
    const bool minus = !name.empty() && name[0] == '-';
    const auto layer = std::find_if(kLayers.begin(), kLayers.end(), [&](const Layer& one) {
      return name.substr(minus ? 1 : 0) == one.name;
    });
    if (layer == kLayers.end() || minus != left_out) {
      throw base::InputError(
          option,
          fmt::format("got \"{}\", expected all, none, or names from {}, all of them with a minus "
                      "sign or none",
                      text, OverlayLayerNames()),
          fmt::format("Write for example: {} net,forces,chart or {} -axes,-candidates", option,
                      option));
    }
    layers.*layer->on = !minus;
  } while (!names.eof());
  return layers;
}

}  // namespace softforce::pipeline
