#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#include <sanitizer/tsan_interface.h>
#define STIPPLE_THREAD_SANITIZER
#endif
#endif

namespace stipple {
namespace {

/// The bodies of a loop come after its beginning and before its end. TBB sees to that, and is no
/// code that ThreadSanitizer has instrumented, so it is told.
class LoopOrder {
#ifdef STIPPLE_THREAD_SANITIZER
  public:
    LoopOrder() {
        __tsan_release(&begin_);
    }
    ~LoopOrder() {
        __tsan_acquire(&end_);
    }
    LoopOrder(const LoopOrder&) = delete;
    LoopOrder& operator=(const LoopOrder&) = delete;

    void run(const std::function<void(int)>& body, int i) {
        __tsan_acquire(&begin_);
        const std::shared_ptr<void> when_done(&end_, __tsan_release);
        body(i);
    }

  private:
    double begin_ = 0;  ///< their addresses stand for the beginning and the end
    double end_ = 0;
#else
  public:
    static void run(const std::function<void(int)>& body, int i) {
        body(i);
    }
#endif
};

}  // namespace

struct ThreadLimit::Impl {
    explicit Impl(std::size_t limit)
        : control(tbb::global_control::max_allowed_parallelism, limit) {}
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    const auto limit =
        static_cast<std::size_t>(threads > 0 ? threads : tbb::this_task_arena::max_concurrency());
    impl_ = std::make_unique<Impl>(limit);
}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    const auto limit =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return static_cast<int>(limit);
}

void run_on_this_thread(const std::function<void()>& body) {
    tbb::task_arena alone(1);
    alone.execute(body);
}

void parallel_for(int begin, int end, const std::function<void(int)>& body) {
    [[maybe_unused]] LoopOrder order;
    tbb::parallel_for(
        begin, end, [&](int i) { order.run(body, i); }, tbb::simple_partitioner());
}

}  // namespace stipple
