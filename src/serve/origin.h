#pragma once

#include <string>

namespace softforce::serve {

// Whether a request's header Host names this machine by a name of its own, and the port. A page of
// another site that has its name resolved to this machine is found out so.
bool IsOwnHost(const std::string& host, int port);

// Whether a request comes from our page, or from no page: the header Origin is absent.
bool IsOwnOrigin(const std::string& origin, int port);

}  // namespace softforce::serve
