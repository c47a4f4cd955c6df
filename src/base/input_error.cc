#include "softforce/base/input_error.h"

namespace softforce::base {

InputError::InputError(const std::string& where, const std::string& problem,
                       const std::string& advice)
    : std::runtime_error(where + ": " + problem + (advice.empty() ? "" : "\n  " + advice)) {}

}  // namespace softforce::base
