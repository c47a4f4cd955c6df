#include "commands/stop.h"

#include <csignal>

namespace softforce::apps {
namespace {

std::atomic<bool> stop_asked{false};

void AskToStop(int signal) {
  stop_asked = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>* StopOnSignal() {
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
  return &stop_asked;
}

}  // namespace softforce::apps
