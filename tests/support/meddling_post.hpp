// A post between a daemon and those who talk to it that delivers replies late, twice and out of order, and lies.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace lightnet::test {

/// Understands packets, as a line can't: of the replies to asks it keeps one back every `period`, and delivers it
/// twice, up to `longest` later. With `lies` it changes a byte of each piece of a result that the daemon gives to
/// another host, in such a way that the packet is sound. All else passes at once.
class MeddlingPost {
public:
    struct Habits {
        std::chrono::milliseconds period{300}, longest{3000};
        std::uint32_t seed = 1;
        bool lies = false;
    };
    MeddlingPost(const std::string& daemon, const Habits& habits);
    ~MeddlingPost();

    /// Where it takes the place of the daemon.
    const std::string& endpoint() const { return endpoint_; }
    /// Replies that came late, and twice; and pieces that were changed.
    std::uint64_t meddled() const { return meddled_; }

private:
    struct Desk;
    void serve(const std::stop_token& stop, Desk& desk);

    std::string endpoint_;
    std::atomic<std::uint64_t> meddled_{0};
    std::jthread thread_;
};

}  // namespace lightnet::test
