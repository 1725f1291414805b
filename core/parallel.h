#pragma once

#include <functional>
#include <memory>

namespace stipple {

/// Limits `parallel_for` to `threads` threads during its lifetime. 0 means all cores.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Threads that `parallel_for` uses now.
[[nodiscard]] int thread_count();

/// Calls `body`, in which `parallel_for` uses the calling thread only. For a background thread that
/// must not use the threads of others.
void run_on_this_thread(const std::function<void()>& body);

/// Calls `body(i)` once for each i in [begin, end), on several threads and in no fixed order.
/// Bodies must write to disjoint memory and must not add up across indices. So every result is
/// independent of the number of threads. The first exception thrown by a body is rethrown.
void parallel_for(int begin, int end, const std::function<void(int)>& body);

}  // namespace stipple
