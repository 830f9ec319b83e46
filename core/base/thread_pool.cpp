#include "core/base/thread_pool.hpp"

#include "core/base/unwanted.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/allowance.hpp"

namespace lightnet {
namespace {

unsigned usual_threads() { return std::min(usable_cores(), 8u); }

}  // namespace

ThreadPool::ThreadPool(unsigned threads) : most_threads_((threads ? threads : usual_threads()) - 1) {}

ThreadPool::~ThreadPool() {
    std::unique_lock lock(tasks_mutex_);
    tasks_.clear();  // somebody gave up
}

void ThreadPool::add(std::function<void()> task) {
    std::unique_lock lock(tasks_mutex_);
    if (most_threads_ == 0 || tasks_.size() >= most_waiting) {
        lock.unlock();
        return task();
    }
    tasks_.push_back({std::move(task), LookingAt::now()});
    if (threads_.size() < most_threads_) start_thread();
    came_.notify_one();
}

// The system may have none left: then those that are there do it all, finish() at the latest.
void ThreadPool::start_thread() try {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
} catch (const std::system_error&) {
    most_threads_ = static_cast<unsigned>(threads_.size());
}

void ThreadPool::finish() {
    std::unique_lock lock(tasks_mutex_);
    while (do_one(lock)) {
    }
    done_.wait(lock, [this] { return tasks_.empty() && under_way_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
}

void ThreadPool::work(const std::stop_token& stop) {
    std::unique_lock lock(tasks_mutex_);
    while (came_.wait(lock, stop, [this] { return !tasks_.empty(); })) do_one(lock);
}

bool ThreadPool::do_one(std::unique_lock<std::mutex>& lock) {
    if (tasks_.empty()) return false;
    const auto task = std::move(tasks_.front());
    tasks_.pop_front();
    ++under_way_;
    lock.unlock();
    const auto failure = failure_of(task);
    lock.lock();
    if (failure && !failure_) failure_ = failure;
    if (--under_way_ == 0 && tasks_.empty()) done_.notify_all();
    return true;
}

std::exception_ptr ThreadPool::failure_of(const Task& task) try {
    const LookingAt looking(task.unwanted);
    end_if_unwanted();
    task.work();
    return nullptr;
} catch (...) {
    return std::current_exception();
}

}  // namespace lightnet
