// A thread pool, for what is independent: a reader goes on through its file while images and meshes are decoded.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lightnet {

/// Does tasks in any order, on threads of its own, as far as the system gives them, which end with it. What depends on
/// the order belongs behind finish(). Called from one thread; tasks share nothing but what never changes. They are
/// unwanted when their giver's work is (core/base/unwanted.hpp), and what of them has not begun then is left out. What
/// a task throws comes back from finish(), as Cancelled or for want of memory; of several, one.
class ThreadPool {
public:
    /// 0 threads: as many as it may use cores, but a few at most. The caller's own counts as one.
    explicit ThreadPool(unsigned threads = 0);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    /// Takes a task; does it at once when too much is waiting, so that what waits stays small: then what it throws
    /// comes from here.
    void add(std::function<void()> task);
    /// Returns when all tasks are done; the caller helps. Throws Cancelled when some were not, as they were unwanted,
    /// or what a task has thrown.
    void finish();

private:
    static constexpr std::size_t most_waiting = 64;
    struct Task {
        std::function<void()> work;
        const std::atomic<bool>* unwanted;
    };

    void work(const std::stop_token& stop);
    void start_thread();
    bool do_one(std::unique_lock<std::mutex>& lock);
    static std::exception_ptr failure_of(const Task& task);

    std::mutex tasks_mutex_;
    std::condition_variable_any came_;
    std::condition_variable done_;
    std::deque<Task> tasks_;
    std::size_t under_way_ = 0;
    std::exception_ptr failure_;  // of a task
    unsigned most_threads_;
    std::vector<std::jthread> threads_;  // started when there is work; first to go
};

/// Calls work(first, last) for pieces of 0 … `count`, on all cores if there is more than one. What it throws comes back
/// to the caller.
template <class Work>
void parallel_for(std::size_t count, const Work& work, std::size_t piece = 1 << 14) {
    if (count <= piece) return work(0, count);
    ThreadPool thread_pool;
    for (std::size_t first = 0; first < count; first += piece)
        thread_pool.add([&work, first, last = std::min(count, first + piece)] { work(first, last); });
    thread_pool.finish();
}

}  // namespace lightnet
