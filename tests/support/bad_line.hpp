// A line to a tcp port that can be cut, held, damaged and slow.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <list>
#include <string>
#include <thread>

namespace lightnet::test {

/// Passes on what comes to its own port, until it is told otherwise. Everything but the constructor may be called from
/// any thread.
class BadLine {
public:
    /// `target`: "tcp://127.0.0.1:PORT".
    explicit BadLine(const std::string& target);
    ~BadLine();

    /// "tcp://127.0.0.1:PORT" of this end.
    std::string endpoint() const;
    /// Resets all connections (RST).
    void cut() { cut_ = true; }
    /// The next that is sent on each connection is cut off in its middle.
    void truncate() { truncate_ = true; }
    /// Nothing passes, and nobody is told.
    void hold(bool on) { held_ = on; }
    enum class Way { to_target, from_target };
    /// Nothing passes this way, and nobody is told.
    void hold(Way way, bool on) { held_ways_[static_cast<std::size_t>(way)] = on; }
    /// One bit is flipped after about so many bytes, again and again; 0: none.
    void flip_every(std::uint64_t bytes) { flip_every_ = bytes; }
    /// No more bytes pass in a second, both ways together; 0: as many as can.
    void limit(double bytes_per_second) { limit_ = bytes_per_second; }

    std::uint64_t cuts() const { return cuts_; }  // of connections
    std::uint64_t flips() const { return flips_; }

private:
    struct Connection {
        int ends[2];
    };
    void serve(const std::stop_token& stop);
    void accept_one();
    bool pass(Connection& connection, int from);
    void wait_for(std::size_t bytes);
    void reset(const Connection& connection);

    int target_port_ = 0, listener_ = -1, port_ = 0;
    std::atomic<bool> cut_{false}, truncate_{false}, held_{false};
    std::array<std::atomic<bool>, 2> held_ways_{};
    std::atomic<std::uint64_t> flip_every_{0}, cuts_{0}, flips_{0};
    std::atomic<double> limit_{0};
    std::uint64_t passed_ = 0;                         // since the last flip
    std::chrono::steady_clock::time_point free_at_{};  // of its limit
    std::list<Connection> connections_;
    std::jthread thread_;
};

}  // namespace lightnet::test
