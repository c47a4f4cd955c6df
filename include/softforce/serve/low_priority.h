#pragma once

namespace softforce::serve {

// Lets the calling thread run only where nobody else wants to.
void RunAtLowestPriority();

}  // namespace softforce::serve
