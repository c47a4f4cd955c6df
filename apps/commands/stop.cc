#include "commands/stop.h"

#include <csignal>

namespace softforce::apps {
namespace {

std::atomic<bool> stop_asked{false};
std::atomic<bool>* also_asked = nullptr;

void AskToStop(int signal) {
  stop_asked = true;
  if (also_asked != nullptr) *also_asked = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>* StopOnSignal(std::atomic<bool>* also) {
  also_asked = also;
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
  return &stop_asked;
}

}  // namespace softforce::apps
