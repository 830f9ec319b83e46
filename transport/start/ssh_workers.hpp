// Daemons that the launcher starts on other machines, by ssh.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"
#include "transport/start/restarts.hpp"

namespace lightnet {

/// On each host one lightnetd, which dials in at the launcher. It is told its secret key by its standard input, so that
/// no command line and no file holds it, and ends when that does: with this object, with the launcher, however that
/// ends, and with the connection. One that is lost is started anew, later and later, and given up when it keeps dying
/// before it was of use.
class SshWorkers {
public:
    using Time = Restarts::Time;

    /// A machine, as ssh is told ("anna@onyx1"); how its daemon is called in the run; and by which key it is known.
    struct Host {
        std::string address, name;
        KeyPair key;
    };
    struct Request {
        std::vector<Host> hosts;
        std::vector<std::string> command;  // ssh, and its options
        std::string program;  // lightnetd, as it may lie there, too; else it is looked for in the PATH there
        std::string join;     // endpoint of the launcher, as others reach it ...
        bool as_seen_from_there = false;  // ... but for its address, which is that from which ssh comes, if it says so
        PublicKey launcher;
    };
    /// Starts all of them, and waits for none. Throws Error when ssh can't be started.
    explicit SshWorkers(Request request);
    /// Ends their input, and, after two seconds, ssh itself.
    ~SshWorkers();
    SshWorkers(const SshWorkers&) = delete;
    SshWorkers& operator=(const SshWorkers&) = delete;

    /// What look_after() tells and asks.
    struct Handlers {
        std::function<bool(const std::string& name)> of_use;  // it serves the run
        std::function<void(const std::string& text)> say;
    };
    /// Starts those anew that have ended. Returns at once.
    void look_after(Time now, const Handlers& handlers);

private:
    struct Worker {
        Host host;
        int process = 0;  // ssh; 0: has ended
        int input = -1;   // of the daemon
        bool was_of_use = false;
        Restarts restarts{};
    };
    void start(Worker& worker);
    void ended(Worker& worker, int status, Time now, const Handlers& handlers);

    Request request_;
    std::vector<Worker> workers_;
};

/// What the shell of a host is told.
std::string ssh_script(const SshWorkers::Request& request, const std::string& name);

}  // namespace lightnet
