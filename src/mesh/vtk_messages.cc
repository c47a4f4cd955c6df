#include "mesh/vtk_messages.h"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>

#include <algorithm>

namespace softforce::mesh {
namespace {

class Collector : public vtkOutputWindow {
 public:
  static Collector* New();
  vtkTypeMacro(Collector, vtkOutputWindow)

      void DisplayText(const char* text) override {
    Keep(text);
  }
  void DisplayErrorText(const char* text) override { Keep(text); }
  void DisplayWarningText(const char* text) override { Keep(text); }
  void DisplayGenericWarningText(const char* text) override { Keep(text); }
  void DisplayDebugText(const char*) override {}

  const std::string& first() const { return first_; }

 private:
  void Keep(const char* text) {
    if (first_.empty() && text != nullptr) first_ = text;
  }
  std::string first_;
};
vtkStandardNewMacro(Collector)

}  // namespace

VtkMessages::VtkMessages()
    : before_(vtkOutputWindow::GetInstance()),
      collector_(vtkSmartPointer<vtkOutputWindow>::Take(Collector::New())),
      verbosity_before_(vtkLogger::GetCurrentVerbosityCutoff()) {
  vtkOutputWindow::SetInstance(collector_);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);  // VTK says everything twice
}

VtkMessages::~VtkMessages() {
  vtkLogger::SetStderrVerbosity(static_cast<vtkLogger::Verbosity>(verbosity_before_));
  vtkOutputWindow::SetInstance(before_);
}

std::string VtkMessages::FirstProblem() const {
  // "ERROR: In file.cxx, line 12\nvtkReader (0x55…): Cannot …\n\n": the text after the address.
  std::string text = static_cast<const Collector&>(*collector_).first();
  const std::size_t address = text.find("): ");
  if (address != std::string::npos) text.erase(0, address + 3);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  // It may quote the file, which may be anything.
  constexpr std::size_t kLongest = 200;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " …";
  return text;
}

}  // namespace softforce::mesh
