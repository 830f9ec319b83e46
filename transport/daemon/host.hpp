// A host: the daemon that lends its cores to one run after the other.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/log_entry.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/tuning.hpp"
#include "transport/keys/key.hpp"

namespace lightnet {

class HostTransport;

/// What a host is at, and has done since it was started. A value.
struct DaemonFigures {
    std::uint32_t places = 0;    // threads that render
    bool serves = false;         // a run, now
    bool leaves = false;         // it was told to stop
    std::uint64_t runs = 0;      // that it began to serve
    std::uint64_t answered = 0;  // bundles and tiles, up to now
    std::uint64_t broken_packets = 0;
    Counters ended;  // of runs that have ended; without traces. Rays, and seconds of places, up to now
    std::chrono::steady_clock::time_point when{};  // they were so; long ago: the thread of serve() hangs
};

/// Listens on one port, or dials out to a launcher and lets nobody in. The thread of serve() owns its sockets: it
/// answers heartbeats, takes in the job and its files, and hands packets on to its places without looking inside, or
/// has a place that idles do this last (see Leadership). Places render in threads of their own, so a busy host never
/// looks dead.
class Host {
public:
    struct Options {
        std::string listen = "tcp://127.0.0.1:*";  // empty: lets nobody in
        std::string join;                          // endpoint of a launcher to report to; empty: wait to be asked
        std::string name;                          // under which it joins; empty: that of the machine
        std::string pass;                          // file with what it must know to join; empty: Pass::usual_file()
        std::optional<KeyPair> key;                // its own; to be had where it asks for keys or has `launcher_key`
        std::string allow;                         // whose keys it lets in, see AllowFile; "": it asks for none
        std::optional<PublicKey> launcher_key;     // of the launcher that it joins; none: that has no key
        std::chrono::milliseconds line_life = usual_line_life;  // of one with keys
        std::uint32_t places = 0;                               // 0: one per core
        std::string ports{};                                    // of daemons that stand for one, see RunPorts
        std::string cache;                                      // folder for blobs; empty: default_cache_folder()
        std::uint64_t cache_size = usual_cache_size;
        std::chrono::milliseconds drain{20'000};            // to answer what it has when it is told to stop
        std::optional<std::chrono::milliseconds> patience;  // it leaves when nobody needs it for so long
        std::function<void(const LogEntry&)> log = [](const LogEntry&) {};  // one thread at a time
        /// Why it was told to stop, for the launcher; "": no matter.
        std::function<std::string()> why_told = [] { return std::string(); };
        std::shared_ptr<HostTransport> transport{};  // to launchers and other hosts; null: by ZeroMQ
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
    /// As they were half a second ago at most, while it serves. May be called by any thread.
    DaemonFigures figures() const;
    /// Some of its own work hangs, in a file system that does not answer for instance. Destroying the host would wait
    /// for it; a program that is to end had better do so at once.
    bool hangs() const;

private:
    struct Service;
    std::unique_ptr<Service> service_;
};

}  // namespace lightnet
