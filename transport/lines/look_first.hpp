// Looks of a thread before it sleeps, where that costs nobody anything.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>

namespace lightnet {

/// Threads of a process that do not sleep, as far as they wait at a Poll now and then or are told of. Any thread.
class AwakeThreads {
public:
    explicit AwakeThreads(unsigned processors) : processors_(static_cast<int>(processors)) {}
    /// Those of this process, and the processors that it may use.
    static AwakeThreads& of_process();

    void come(int threads = 1) { awake_ += threads; }
    void go(int threads = 1) { awake_ -= threads; }
    /// So many that are awake as long as this lives.
    class Told {
    public:
        explicit Told(int threads, AwakeThreads& among = of_process()) : threads_(threads), among_(among) {
            among_.come(threads_);
        }
        ~Told() { among_.go(threads_); }
        Told(const Told&) = delete;
        Told& operator=(const Told&) = delete;

    private:
        const int threads_;
        AwakeThreads& among_;
    };
    /// One of them may go on although it has nothing to do: there is a processor for each.
    bool has_room() const { return awake_ <= processors_; }

private:
    const int processors_;
    std::atomic<int> awake_{0};
};

/// What one thread does before it sleeps: where a processor is free, it looks for what comes for 20 µs at most, as
/// being woken takes longer. Never while another program wants the processor, and seldom where nothing has come before.
/// DECISIONS: who-waits-sleeps
class LookFirst {
public:
    using Time = std::chrono::steady_clock::time_point;
    using Clock = std::function<Time()>;
    explicit LookFirst(const AwakeThreads& awake = AwakeThreads::of_process(),
                       Clock clock = std::chrono::steady_clock::now)
        : awake_(awake), clock_(std::move(clock)) {}

    /// True: `found` was, after some looks. False: it is time to sleep.
    bool look(const std::function<bool()>& found);

private:
    bool look_until(Time begun, const std::function<bool()>& found);

    const AwakeThreads& awake_;
    Clock clock_;
    Time none_before_{};         // another program wanted the processor
    unsigned in_vain_ = 0;       // looks, one after the other
    unsigned to_leave_out_ = 0;  // waits
};

}  // namespace lightnet
