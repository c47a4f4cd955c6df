#pragma once

#include <atomic>

namespace softforce::apps {

// Ctrl-C from now on sets the flag, so that long work ends after the current frame; a second one
// ends at once.
const std::atomic<bool>* StopOnSignal();

}  // namespace softforce::apps
