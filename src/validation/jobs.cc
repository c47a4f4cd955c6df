#include "validation/jobs.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "softforce/base/progress.h"

namespace softforce::validation {

void RunJobs(const std::vector<std::function<void()>>& jobs, int threads,
             const std::string& label) {
  std::atomic<size_t> next{0};
  std::mutex mutex;  // for what follows
  int done = 0;
  std::exception_ptr failure;
  std::optional<base::Progress> progress;
  if (!label.empty()) progress.emplace(label, static_cast<int>(jobs.size()));
  const auto work = [&] {
    for (size_t i = next++; i < jobs.size(); i = next++) {
      try {
        jobs[i]();
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = jobs.size();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
      if (progress) progress->Update(done);
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  if (progress) progress->Finish();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace softforce::validation
