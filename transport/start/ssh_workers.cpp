#include "transport/start/ssh_workers.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "transport/start/child.hpp"
#include "transport/start/shell_word.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto farewell = std::chrono::seconds(2);

std::string how_it_ended(int status) {
    if (WIFSIGNALED(status)) return "was ended by a signal";
    const int code = WEXITSTATUS(status);
    if (code == 255) return "could not connect, or lost its connection (code 255)";
    if (code == 127) return "found no lightnetd there (code 127): install it, or say --ssh-daemon PATH";
    return "has ended with code " + std::to_string(code);
}

// DECISIONS: ssh-holds-by-input
// What the daemon there reads first. Whoever is gone already doesn't read it.
void tell_key(int input, const KeyPair& key) {
    const auto line = key.secret_text() + "\n";
    if (write(input, line.data(), line.size()) < 0) return;
}

}  // namespace

// The users' shell there may be any; what it gets is one command for sh. Where the launcher listens at all its
// addresses, the one to dial is that from which ssh came.
std::string ssh_script(const SshWorkers::Request& request, const std::string& name) {
    const auto colon = request.join.rfind(':');
    const std::string host = request.join.substr(6, colon - 6), port = request.join.substr(colon);
    std::string script = "a=" + as_shell_word(host) + "; ";
    if (request.as_seen_from_there)
        script += "c=${SSH_CONNECTION%% *}; case \"$c\" in *:*) a=\"[$c]\";; ?*) a=$c;; esac; ";
    script += "d=" + as_shell_word(request.program) + "; [ -x \"$d\" ] || d=lightnetd; ";
    script += "exec \"$d\" --led --quiet --join \"tcp://$a" + port + "\" --name " + as_shell_word(name) +
              " --launcher-key " + request.launcher.text();
    return "exec sh -c " + as_shell_word(script);
}

SshWorkers::SshWorkers(Request request) : request_(std::move(request)) {
    for (auto& host : request_.hosts) workers_.push_back({.host = std::move(host)});
    try {
        for (auto& worker : workers_) start(worker);
    } catch (...) {
        for (const auto& worker : workers_) {
            if (worker.input >= 0) close(worker.input);
            if (worker.process) kill(worker.process, SIGTERM);
        }
        throw;
    }
}

SshWorkers::~SshWorkers() {
    for (const auto& worker : workers_)
        if (worker.input >= 0) close(worker.input);
    const auto end = Clock::now() + farewell;
    for (const auto& worker : workers_)
        while (worker.process && waitpid(worker.process, nullptr, WNOHANG) == 0) {
            if (Clock::now() > end + farewell)
                kill(worker.process, SIGKILL);
            else if (Clock::now() > end)
                kill(worker.process, SIGTERM);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
}

void SshWorkers::start(Worker& worker) {
    auto words = request_.command;
    words.push_back(worker.host.address);
    words.push_back(ssh_script(request_, worker.host.name));
    worker.process = spawn_led(std::move(words), &worker.input);
    worker.was_of_use = false;
    tell_key(worker.input, worker.host.key);
}

void SshWorkers::look_after(Time now, const Handlers& handlers) {
    for (auto& worker : workers_) {
        if (worker.process) {
            int status = 0;
            worker.was_of_use |= handlers.of_use(worker.host.name);
            if (waitpid(worker.process, &status, WNOHANG) == worker.process) ended(worker, status, now, handlers);
        } else if (worker.restarts.due(now)) {
            start(worker);
        }
    }
}

// One that ends well was told to by somebody there.
void SshWorkers::ended(Worker& worker, int status, Time now, const Handlers& handlers) {
    worker.process = 0;
    close(std::exchange(worker.input, -1));
    const bool told = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    worker.restarts.died(now, worker.was_of_use);
    if (told) worker.restarts.give_up();
    handlers.say("ssh to " + worker.host.address + ": " +
                 (told                         ? "its daemon was told to stop"
                  : worker.restarts.given_up() ? how_it_ended(status) + "; it is given up"
                                               : how_it_ended(status) + "; it is tried again"));
}

}  // namespace lightnet
