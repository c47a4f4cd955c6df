#include "pipeline/display.h"

#include <X11/Xlib.h>

#include <cstdlib>

namespace softforce::pipeline {
namespace {

bool IsSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

std::string WhyNoDisplay() {
  if (IsSet("QT_QPA_PLATFORM") || IsSet("WAYLAND_DISPLAY")) return "";
  if (!IsSet("DISPLAY")) return "DISPLAY is not set: there is no screen here";
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr) {
    return "the display " + std::string(std::getenv("DISPLAY")) + " does not answer";
  }
  XCloseDisplay(display);
  return "";
}

}  // namespace softforce::pipeline
