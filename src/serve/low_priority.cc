#include "softforce/serve/low_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace softforce::serve {

void RunAtLowestPriority() {
  // On Linux the priority is the thread's own, and anybody may lower it.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19);
}

}  // namespace softforce::serve
