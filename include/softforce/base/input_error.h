#pragma once

#include <stdexcept>
#include <string>

namespace softforce::base {

// Bad data from outside the program: a file, an option, a recording. Thrown where the data is read
// or checked, caught once in main, which prints it and exits with code 2.
//
// The text says where, what (got and expected), and what to do:
//   calib/rig.yaml: camera "right": T_camera_rig: rotation has determinant 0.87, must be 1 within
//   1e-6.
//     Write the matrix with at least 7 digits, as the calibration gave it.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& where, const std::string& problem, const std::string& advice = "");
};

}  // namespace softforce::base
