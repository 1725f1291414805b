#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace stipple {

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
    tbb::parallel_for(begin, end, body, tbb::simple_partitioner());
}

}  // namespace stipple
