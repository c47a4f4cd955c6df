#include "mesh/isolated.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <type_traits>

#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

enum Outcome : std::int64_t { kDone = 1, kRefused, kFailed };

// Values in a file that two processes of one program share.
class Channel {
 public:
  Channel() : file_(std::tmpfile()) {
    if (file_ == nullptr) throw std::runtime_error("no room for a temporary file");
  }
  ~Channel() { std::fclose(file_); }
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  void Rewind() { std::rewind(file_); }
  bool Flush() { return std::fflush(file_) == 0 && std::ferror(file_) == 0; }

  template <typename T>
  void Put(const T* values, std::size_t count) {
    static_assert(std::is_arithmetic_v<T>);
    std::fwrite(values, sizeof(T), count, file_);
  }
  void Put(std::int64_t value) { Put(&value, 1); }
  void Put(const std::string& text) {
    Put(static_cast<std::int64_t>(text.size()));
    Put(text.data(), text.size());
  }

  template <typename T>
  void Get(T* values, std::size_t count) {
    if (std::fread(values, sizeof(T), count, file_) != count) {
      throw std::runtime_error("a temporary file is cut off: is the disk full?");
    }
  }
  std::int64_t Get() {
    std::int64_t value = 0;
    Get(&value, 1);
    return value;
  }
  std::string GetText() {
    std::string text(static_cast<std::size_t>(Get()), ' ');
    Get(text.data(), text.size());
    return text;
  }

 private:
  std::FILE* file_;
};

void Put(const GeneratedMesh& generated, Channel& channel) {
  const TetMesh& mesh = generated.mesh;
  channel.Put(&generated.solid_volume, 1);
  channel.Put(static_cast<std::int64_t>(generated.warnings.size()));
  for (const std::string& warning : generated.warnings) channel.Put(warning);
  channel.Put(mesh.num_nodes());
  channel.Put(mesh.nodes.data(), mesh.nodes.size());
  channel.Put(mesh.elements.rows());
  channel.Put(mesh.num_elements());
  channel.Put(mesh.elements.data(), mesh.elements.size());
  channel.Put(mesh.region.data(), mesh.region.size());
  channel.Put(static_cast<std::int64_t>(mesh.region_names.size()));
  for (const std::string& name : mesh.region_names) channel.Put(name);
  channel.Put(static_cast<std::int64_t>(mesh.surface_groups.size()));
  for (const auto& [name, triangles] : mesh.surface_groups) {
    channel.Put(name);
    channel.Put(static_cast<std::int64_t>(triangles.size()));
    for (const auto& triangle : triangles) channel.Put(triangle.data(), 3);
  }
}

GeneratedMesh Get(Channel& channel) {
  GeneratedMesh generated;
  TetMesh& mesh = generated.mesh;
  channel.Get(&generated.solid_volume, 1);
  generated.warnings.resize(channel.Get());
  for (std::string& warning : generated.warnings) warning = channel.GetText();
  mesh.nodes.resize(3, channel.Get());
  channel.Get(mesh.nodes.data(), mesh.nodes.size());
  const std::int64_t rows = channel.Get();
  mesh.elements.resize(rows, channel.Get());
  channel.Get(mesh.elements.data(), mesh.elements.size());
  mesh.region.resize(mesh.elements.cols());
  channel.Get(mesh.region.data(), mesh.region.size());
  mesh.region_names.resize(channel.Get());
  for (std::string& name : mesh.region_names) name = channel.GetText();
  for (std::int64_t groups = channel.Get(); groups > 0; --groups) {
    auto& triangles = mesh.surface_groups[channel.GetText()];
    triangles.resize(channel.Get());
    for (auto& triangle : triangles) channel.Get(triangle.data(), 3);
  }
  return generated;
}

// What the child does; it never returns, so that nothing of the parent's is torn down twice.
[[noreturn]] void RunInChild(const std::function<GeneratedMesh()>& work, Channel& channel) {
  for (const int crash : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(crash, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // the work ends with the program
  if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr)) _exit(1);
  try {
    const GeneratedMesh generated = work();
    channel.Put(kDone);
    Put(generated, channel);
  } catch (const base::InputError& error) {
    channel.Put(kRefused);
    channel.Put(std::string(error.what()));
  } catch (const std::exception& error) {
    channel.Put(kFailed);
    channel.Put(std::string(error.what()));
  } catch (...) {
    _exit(1);
  }
  _exit(channel.Flush() ? 0 : 1);
}

}  // namespace

GeneratedMesh RunIsolated(const std::string& where, const std::function<GeneratedMesh()>& work) {
  Channel channel;
  std::fflush(nullptr);  // or the child would write the parent's pending output again
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child == 0) RunInChild(work, channel);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw base::InputError(where,
                           WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL
                               ? "meshing it was ended from outside; memory may have run out"
                               : "Gmsh crashes on it: the file is damaged, or Gmsh has a fault",
                           "Export it again, and open it in Gmsh to see more; or take a larger "
                           "--size.");
  }
  channel.Rewind();
  const std::int64_t outcome = channel.Get();
  if (outcome == kDone) return Get(channel);
  const std::string text = channel.GetText();
  if (outcome == kFailed) throw std::runtime_error(text);
  const std::string prefix = where + ": ";  // which InputError puts there again
  throw base::InputError(where, text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text);
}

}  // namespace softforce::mesh
