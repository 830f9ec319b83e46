// A viewer for tests that speaks tev's protocol, byte by byte.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/slowdown.hpp"

namespace lightnet::test {

/// Listens, and takes what comes on one connection after the other.
class TevViewer {
public:
    struct Image {
        int width = 0, height = 0;
        std::map<std::string, std::vector<float>> channels;
    };
    struct Seen {
        std::map<std::string, Image> images;
        std::vector<std::string> opened;  // files
        std::vector<std::string> errors;  // what no viewer would take
        int connections = 0, updates = 0;
    };

    /// 0: a port that is free.
    explicit TevViewer(std::uint16_t port = 0);
    ~TevViewer();
    TevViewer(const TevViewer&) = delete;
    TevViewer& operator=(const TevViewer&) = delete;

    std::uint16_t port() const { return port_; }
    Seen seen() const;
    /// Until that is true of what was seen, or too long.
    bool wait_for(const std::function<bool(const Seen&)>& what);

private:
    void serve();
    void take(int connection);
    void take_packet(const std::string& packet);

    int listener_ = -1;
    int ends_[2] = {-1, -1};  // a pipe
    std::uint16_t port_ = 0;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Seen seen_;
    std::thread thread_;
};

}  // namespace lightnet::test
