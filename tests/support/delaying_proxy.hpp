// A line between two ends of tcp on which everything takes its time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <random>
#include <string>
#include <thread>

namespace lightnet::test {

/// What a line loses is sent again by the system, and comes later: `share` of all pieces by `delay`, and all behind
/// them.
struct LineLoss {
    double share = 0;
    std::chrono::microseconds delay{0};
    std::uint32_t seed = 1;
};

/// Passes on what comes, in both directions, `delay` after it came, on a thread of its own. Loopback only.
class DelayingProxy {
public:
    /// `to`: "tcp://127.0.0.1:port". Throws std::runtime_error when it can't listen.
    DelayingProxy(const std::string& to, std::chrono::microseconds delay, const LineLoss& loss = {});
    ~DelayingProxy();
    DelayingProxy(const DelayingProxy&) = delete;
    DelayingProxy& operator=(const DelayingProxy&) = delete;

    /// Where it listens instead.
    std::string endpoint() const;
    /// Bytes passed on so far, both directions.
    std::uint64_t bytes() const { return bytes_; }
    /// Keeps what it passes on from now on.
    void listen_in() { listens_ = true; }
    /// Has it passed on this text since?
    bool has_heard(const std::string& text) const;
    /// Pieces that were lost and sent again.
    std::uint64_t losses() const { return losses_; }

private:
    void serve(const std::stop_token& stop);
    bool lose_one();

    std::chrono::microseconds delay_;
    LineLoss loss_;
    std::mt19937 random_;
    std::atomic<std::uint64_t> losses_{0};
    std::uint16_t to_ = 0, port_ = 0;
    int listener_ = -1;
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<bool> listens_{false};
    mutable std::mutex heard_mutex_;
    std::string heard_;
    std::jthread thread_;
};

}  // namespace lightnet::test
