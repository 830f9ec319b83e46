// A host: the daemon that lends its cores to one run after the other.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/network/graph/kind.hpp"
#include "transport/store/cache_folder.hpp"

namespace lightnet {

/// Listens on one port, or dials out to a launcher and lets nobody in. The thread of serve() owns its sockets: it
/// answers heartbeats, takes in the job and its files, and hands packets on to its places without looking inside.
/// Places render in threads of their own, so a busy host never looks dead.
class Host {
public:
    struct Options {
        std::string listen = "tcp://127.0.0.1:*";  // empty: lets nobody in
        std::string join;                          // endpoint of a launcher to report to; empty: wait to be asked
        std::string name;                          // under which it joins; empty: that of the machine
        std::string pass;                          // file with what it must know to join; empty: Pass::usual_file()
        std::uint32_t places = 0;                  // 0: one per core
        std::string cache;                         // folder for blobs; empty: default_cache_folder()
        std::uint64_t cache_size = usual_cache_size;
        std::chrono::milliseconds drain{20'000};            // to answer what it has when it is told to stop
        std::optional<std::chrono::milliseconds> patience;  // it leaves when nobody needs it for so long
        std::function<void(const std::string&)> log = [](const std::string&) {};
    };
    /// Throws Error when the port can't be had, or the system has too few descriptors.
    Host(Options options, const Registry& registry);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    /// Where it listens, with the port that the system chose; empty: nowhere.
    std::string endpoint() const;
    /// Serves until `stop` is set; then takes no more work, answers what it has, and returns, after `drain` at the
    /// latest.
    void serve(const std::atomic<bool>& stop);
    /// Some of its own work hangs, in a file system that does not answer for instance. Destroying the host would wait
    /// for it; a program that is to end had better do so at once.
    bool hangs() const;

private:
    struct Service;
    std::unique_ptr<Service> service_;
};

}  // namespace lightnet
