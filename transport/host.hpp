// A host: the daemon that lends its cores to one run after the other.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/graph/kind.hpp"

namespace lightnet {

/// Listens on one port. The thread of serve() owns it: it answers heartbeats, takes in the job and its files, and hands
/// packets on to its places without looking inside. Places render in threads of their own, so a busy host never looks
/// dead.
class Host {
public:
    struct Options {
        std::string listen = "tcp://127.0.0.1:*";
        std::string join;          // endpoint of a launcher to report to; empty: wait to be asked
        std::uint32_t places = 0;  // 0: one per core
        std::string cache;         // folder for blobs; empty: default_cache_folder()
        std::function<void(const std::string&)> log = [](const std::string&) {};
    };
    /// Throws Error when the port can't be had.
    Host(Options options, const Registry& registry);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    /// Where it listens, with the port that the system chose.
    std::string endpoint() const;
    /// Serves until `stop` is set, then tells the launcher, which takes the work back, and returns: within some
    /// seconds, whatever the launcher does.
    void serve(const std::atomic<bool>& stop);

private:
    struct Door;
    std::unique_ptr<Door> door_;
};

}  // namespace lightnet
