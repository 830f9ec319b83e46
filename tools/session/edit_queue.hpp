// Edits that come while a session renders.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tools/support/signals.hpp"

namespace lightnet {

/// Reads lines, and looks after files, on a thread of its own. Whatever comes makes the picture at work one that nobody
/// wants any more. The rest is for one thread.
class EditQueue {
public:
    /// `in`: a descriptor to read lines from. Throws Error where the system refuses what it needs.
    explicit EditQueue(int in);
    ~EditQueue();
    EditQueue(const EditQueue&) = delete;
    EditQueue& operator=(const EditQueue&) = delete;

    /// For runs: set by the user's signals, and when something has come.
    const Signals& signals() const { return signals_; }
    /// A file that is written or replaced is an edit, from now on; all others no longer are.
    void watch(const std::set<std::string>& files);

    /// A line that comes another way. Any thread.
    void add(std::string line);

    struct News {
        std::vector<std::string> lines;
        std::set<std::string> files;                                   // that have changed, by their absolute names
        bool ended = false;                                            // no more lines will come
        std::optional<std::chrono::steady_clock::time_point> since{};  // when the first of them came; none: none has
    };
    /// What has come since; the picture that is begun next is wanted.
    News take();
    /// Waits until something comes, no more can, or a signal does.
    void wait();

private:
    void listen();
    bool read_lines();
    void read_changes();
    void pass_on_signals();
    void supersede();
    bool something() const { return !news_.lines.empty() || !news_.files.empty() || news_.ended; }

    const int in_, changes_, wake_;
    Signals signals_;
    std::string rest_;       // of a line; the thread's
    std::mutex news_mutex_;  // the five below
    std::condition_variable came_;
    News news_;
    std::set<std::string> files_;
    std::map<std::string, int> folders_;
    bool last_words_ = false;  // it ends
    std::thread thread_;       // last: it uses the rest
};

}  // namespace lightnet
