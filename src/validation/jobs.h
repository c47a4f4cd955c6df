#pragma once

#include <functional>
#include <string>
#include <vector>

namespace softforce::validation {

// Runs every job once, on so many threads. The first exception thrown by a job is thrown again when
// all threads have ended. Shows on standard error how many are done, under `label` if it is not
// empty.
void RunJobs(const std::vector<std::function<void()>>& jobs, int threads, const std::string& label);

}  // namespace softforce::validation
