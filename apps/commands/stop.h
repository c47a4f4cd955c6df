#pragma once

#include <atomic>

namespace softforce::apps {

// Ctrl-C from now on sets the flag, so that long work ends after the current frame; a second one
// ends at once.
// Sets `also`, too, which must live on.
const std::atomic<bool>* StopOnSignal(std::atomic<bool>* also = nullptr);

}  // namespace softforce::apps
