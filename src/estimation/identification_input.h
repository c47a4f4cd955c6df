#pragma once

#include <vector>

#include "softforce/estimation/identification.h"

namespace softforce::estimation {

// Throws InputError for states or unknowns that do not fit the body.
void CheckInput(const fem::Body& body, const std::vector<KnownState>& states,
                const std::vector<Unknown>& unknowns);

}  // namespace softforce::estimation
