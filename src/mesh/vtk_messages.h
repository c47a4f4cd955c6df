#pragma once

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>

namespace softforce::mesh {

// While it lives, what VTK would print on the terminal is collected here.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  // The essence of the first error or warning, on one line; empty if there was none.
  std::string FirstProblem() const;

 private:
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkSmartPointer<vtkOutputWindow> collector_;
  int verbosity_before_;  // of VTK's logger on standard error
};

}  // namespace softforce::mesh
